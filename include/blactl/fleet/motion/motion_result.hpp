#pragma once
// The behaviour of a servo while it was commanded, compared with the command.

#include "blactl/bla/faults.hpp"
#include "blactl/fleet/motion/motion_plan.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The command and the measured values at one moment, as register values; empty: no response.
struct MotionSample {
  Time at{};               ///< halfway between the request for the angle and its response
  Duration after{};        ///< since the first command
  std::int64_t target = 0; ///< of MotionPlan::parameter
  std::optional<std::int64_t> angle{}, speed{}, torque{}; ///< 0x08-0x0A, one after the other
};

/// The result of a command.
struct MotionResult {
  std::vector<MotionSample> samples{};
  std::size_t commands = 0;               ///< sent, not counting those of the end
  Time began{};                           ///< the time of the first one
  std::optional<std::int64_t> held{};     ///< the angle held instead of the target
  bool is_cut = false;                    ///< ended early
  bool is_shown = false;                  ///< the register showed the command
  bool has_restarted = false;             ///< during the command
  bool is_ended = false;                  ///< ended: its register and its shaft show it
  bla::Values timeout{};                  ///< 0x26 and 0x27 at the end
  std::optional<std::int64_t> output{};   ///< 0x20 at the end
  std::optional<bla::Fault> protection{}; ///< what holds the output off at the end
  std::optional<Error> error{};           ///< why it did not go as planned, or did not end

  [[nodiscard]] bool has_commanded() const { return commands > 0; }
};

/// The servo's own behaviour now that the commands have ended (4.19): "1000 ms after the last
/// command the output goes off".
[[nodiscard]] std::string after_commands(const MotionPlan& plan, const MotionResult& result);

/// Whether its output is still on at the end, and no protection holds it off: an angle is held.
[[nodiscard]] bool holds(const MotionPlan& plan, const MotionResult& result);

/// The distance of two values of 0x08, in tenths of a degree: 179.9 and -180.0 are one apart.
[[nodiscard]] std::int64_t between(std::int64_t angle, std::int64_t other);

/// Whether the shaft counts as being at an angle. unproven: within 1 deg, or its dead band and half
/// a degree, 5 deg at most.
[[nodiscard]] bool is_at(const MotionPlan& plan, std::int64_t angle, std::int64_t target);

/// Compares the motion of the shaft with the command; empty: it agrees, as far as can be seen.
/// Errors: mismatch: an angle was not reached, the speed was not attained, or nothing shows that an
/// ArrayCommand was accepted; timeout: too few responses came in time. A torque is not judged: the
/// shaft need not turn.
[[nodiscard]] std::optional<Error> judge_motion(const MotionPlan& plan, const MotionResult& result);

/// The step response of a shaft.
struct StepResponse {
  std::optional<Duration> settled{};  ///< after the first command; it stayed there from then on
  std::int64_t overshoot_decideg = 0; ///< beyond the target
};

/// For a command of one angle.
[[nodiscard]] StepResponse step_response(const MotionPlan& plan, const MotionResult& result);

} // namespace blactl::fleet
