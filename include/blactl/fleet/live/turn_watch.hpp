#pragma once
// Detects that a shaft is turned by hand.

#include "blactl/base/time.hpp"

#include <chrono>
#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Compares angles with the angle at rest. Slow turns are detected, too, once they have gone far
/// enough; the angle where a turn stops is the new rest.
class TurnWatch {
 public:
  /// Larger than the sway of a shaft without torque: 2 deg, in 0.1 deg.
  static constexpr std::int64_t least_turn = 20;

  /// The time after its last motion for which the shaft counts as turned: long enough to look from
  /// the horn to the screen.
  static constexpr Duration told_for = std::chrono::seconds(5);

  /// An angle in 0.1 deg.
  void take(std::int64_t decideg, Time at);

  /// Discards the angle at rest.
  void forget() { rest_.reset(); }

  [[nodiscard]] bool has_turned(Time now) const {
    return turned_at_ && now - *turned_at_ < told_for;
  }

 private:
  std::optional<std::int64_t> rest_{};
  std::optional<Time> turned_at_{};
};

} // namespace blactl::fleet
