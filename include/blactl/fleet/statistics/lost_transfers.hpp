#pragma once
// How many transfers of one sender and type are missing between those that came.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Transfer IDs count on by one modulo 32 (DroneCAN specification 4.1), so a gap tells how many
/// were lost, but not whether 32 more were, nor whether the sender began anew. Therefore a gap is
/// counted only where the time since the last transfer agrees with it, judged by the usual period;
/// what does not agree is a jump.
class LostTransfers {
 public:
  /// The next one that came whole. Those that came broken are missing, too.
  void take(dronecan::TransferId id, Time at);

  /// Empty: no two came one right after the other, so nothing is known of the period.
  [[nodiscard]] std::optional<std::uint64_t> lost() const {
    return usual_us_ ? std::optional(lost_) : std::nullopt;
  }

  /// How often the IDs went on as no loss explains: after a restart, a silence in which 32
  /// transfers fit, with two senders of one node ID, or where clocks went back.
  [[nodiscard]] std::uint64_t jumps() const { return jumps_; }

 private:
  [[nodiscard]] bool explains(unsigned steps, double elapsed_us) const;
  [[nodiscard]] bool is_round(double elapsed_us) const;
  void take_next(double elapsed_us);
  void learn(double elapsed_us);

  std::optional<dronecan::TransferId> last_;
  Time at_{};
  std::optional<double> usual_us_; ///< from one to the next
  std::uint64_t lost_ = 0, jumps_ = 0;
  bool was_silent_ = false; ///< for 32 periods, before the last one
  bool pauses_ = false;     ///< it sends in bursts, or has changed its rate
};

} // namespace blactl::fleet
