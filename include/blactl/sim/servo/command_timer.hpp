#pragma once
// The time since a simulated servo was last commanded: for the communication timeout (4.19) and the
// validity of the PWM input (4.30).

#include "blactl/base/time.hpp"

#include <algorithm>
#include <optional>

namespace blactl::sim {

class CommandTimer {
 public:
  /// The servo begins to run; the timeout counts from here. `pwm_waits`: so does the wait of the
  /// PWM input.
  void start(Time now, bool pwm_waits) {
    last_ = now;
    last_can_ = pwm_waits ? std::optional(now) : std::nullopt;
  }

  void commanded(Time at) { last_ = at; }

  /// A command came by CAN. `feeds`: it restarts the timeout; `silences_pwm`: the wait of the PWM
  /// input restarts.
  void commanded_by_can(Time at, bool feeds, bool silences_pwm = true) {
    last_can_ = silences_pwm ? std::optional(at) : last_can_;
    last_ = feeds ? at : last_;
  }

  /// Requirement 145: `limit` or longer without a command.
  [[nodiscard]] bool timed_out(Time at, Duration limit) const { return at - last_ >= limit; }

  /// Requirements 156, 157.
  [[nodiscard]] bool accepts_pwm(Time at, Duration limit) const {
    return !last_can_ || at - *last_can_ >= limit;
  }

  /// The time at which one of the two results changes without a further call.
  [[nodiscard]] Time next_change(Time at, Duration limit) const {
    const Time pwm = accepts_pwm(at, limit) ? never : *last_can_ + limit;
    return timed_out(at, limit) ? pwm : std::min(pwm, last_ + limit);
  }

 private:
  Time last_{};
  std::optional<Time> last_can_;
};

} // namespace blactl::sim
