#pragma once
// What a servo did while it was commanded, and whether that is what it was told.

#include "blactl/fleet/motion/command_plan.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::fleet {

/// What a servo was told, and did, at one moment. Register numbers; empty: it did not answer.
struct CommandSample {
  Time at{};               ///< in the middle between the question about the angle and its answer
  Duration after{};        ///< the first command
  std::int64_t target = 0; ///< of CommandPlan::parameter
  std::optional<std::int64_t> angle{}, speed{}, torque{}; ///< 0x08-0x0A, one after the other
};

/// How it ended.
struct CommandResult {
  std::vector<CommandSample> samples{};
  std::size_t commands = 0;           ///< that went out, the end apart
  Time began{};                       ///< when the first one did
  std::optional<std::int64_t> held{}; ///< an angle that it was told to hold instead of the target
  bool is_cut = false;                ///< brought to its end before its time
  bool is_shown = false;              ///< the register held what was commanded
  bool has_restarted = false;         ///< meanwhile
  bool is_ended = false; ///< it was brought to its end: its register and its shaft show that
  bla::Values timeout{}; ///< 0x26 and 0x27 in the end
  std::optional<std::int64_t> output{}; ///< 0x20 in the end
  std::optional<Error> error{};         ///< why it was not carried out as planned, or not ended

  [[nodiscard]] bool has_commanded() const { return commands > 0; }
};

/// What the servo does by itself now that the commands have ended (4.19): "1000 ms after the last
/// command the output goes off".
[[nodiscard]] std::string after_commands(const CommandPlan& plan, const CommandResult& result);

/// Whether its output is on in the end as it was before, so that an angle is held.
[[nodiscard]] bool holds(const CommandPlan& plan, const CommandResult& result);

/// How far apart two values of 0x08 are, in tenths of a degree: 179.9 and -180.0 are one apart.
[[nodiscard]] std::int64_t between(std::int64_t angle, std::int64_t other);

/// Whether this counts as being at an angle. unproven: within 1 deg, or its dead band and half a
/// degree.
[[nodiscard]] bool is_at(const CommandPlan& plan, std::int64_t angle, std::int64_t target);

/// What the shaft did is not what it was told; empty: it did, as far as that can be told. Errors:
/// mismatch: an angle was not reached, it did not come to its speed, or nothing shows that an
/// ArrayCommand was taken; timeout: its answers came too late to see what it did. Of a torque
/// nothing is judged: it need not turn.
[[nodiscard]] std::optional<Error> judge_motion(const CommandPlan& plan,
                                                const CommandResult& result);

/// How a shaft came to an angle.
struct StepResponse {
  std::optional<Duration> settled{};  ///< after the first command; from then on it was there
  std::int64_t overshoot_decideg = 0; ///< beyond the target
};

/// Of a command of one angle.
[[nodiscard]] StepResponse step_response(const CommandPlan& plan, const CommandResult& result);

} // namespace blactl::fleet
