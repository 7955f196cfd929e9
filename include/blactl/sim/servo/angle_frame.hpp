#pragma once
// The count of a servo's shaft angle: 0x23, 0x44, and the turns that it has lost (4.1, 4.16, 4.17,
// 4.36).

#include "blactl/sim/servo/controller.hpp"
#include "blactl/sim/servo/shaft.hpp"

#include <cstdint>

namespace blactl::sim {

class AngleFrame {
 public:
  /// Sets 0x23 and 0x44; the turns stay.
  void set(bool reversed, std::int64_t origin_decideg) {
    sign_ = reversed ? -1 : 1;
    origin_decideg_ = origin_decideg;
  }

  /// Requirement 183: like set(), while the servo runs. With 0x44 the seam moves at once: an angle
  /// of -180.0 to +179.9 deg stays within that range. intentional: further turns stay, as 4.36 does
  /// not mention them.
  void change(bool reversed, std::int64_t origin_decideg, const Shaft& shaft);

  /// Requirement 46: brings the angle of the shaft back to -180.0 to +179.9 deg.
  void wrap(const Shaft& shaft);

  /// 1, or -1 if reversed.
  [[nodiscard]] std::int64_t sign() const { return sign_; }

  [[nodiscard]] Position position(const Shaft& shaft) const;

  /// The angle as in 0x08.
  [[nodiscard]] std::int64_t decideg(const Shaft& shaft) const;

  /// The shaft position for this reading, before any turn.
  [[nodiscard]] std::int64_t shaft_angle(std::int64_t decideg) const {
    return (sign_ * decideg + origin_decideg_) * angle_per_decideg;
  }

 private:
  std::int64_t sign_ = 1;
  std::int64_t origin_decideg_ = 0;
  std::int64_t turns_ = 0; ///< whole turns of the shaft that are not counted
};

} // namespace blactl::sim
