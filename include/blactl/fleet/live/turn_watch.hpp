#pragma once
// Notices that a hand turns a shaft.

#include "blactl/base/time.hpp"

#include <chrono>
#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Compares angles with that at rest. What turns slowly is noticed too, as soon as it has gone far
/// enough; where it stops is the new rest.
class TurnWatch {
 public:
  /// More than a shaft without torque sways by itself: 2 deg, in 0.1 deg.
  static constexpr std::int64_t least_turn = 20;

  /// So long after it moved last it counts as turned: as long as a look from the horn to the
  /// screen.
  static constexpr Duration told_for = std::chrono::seconds(5);

  /// An angle in 0.1 deg.
  void take(std::int64_t decideg, Time at);

  /// Nothing is known of the angle any more.
  void forget() { rest_.reset(); }

  [[nodiscard]] bool has_turned(Time now) const {
    return turned_at_ && now - *turned_at_ < told_for;
  }

 private:
  std::optional<std::int64_t> rest_{};
  std::optional<Time> turned_at_{};
};

} // namespace blactl::fleet
