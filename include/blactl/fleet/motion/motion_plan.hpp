#pragma once
// The plan of a command to the shaft of one servo for a limited time, checked before the first
// frame that moves anything.

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/faults.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The wanted motion of a servo's shaft.
struct CommandWanted {
  std::optional<bla::Assignment> target{}; ///< of 0x00-0x02; empty: a wiggle, to identify it
  Duration duration = std::chrono::seconds(2);
  bool by_servo_id = false; ///< by ArrayCommand instead of 0x00-0x02 of the node
};

/// A target that applies from a time on, counted from the first command.
struct Waypoint {
  Duration from{};
  std::int64_t raw = 0;
};

/// A quantity read while a servo is commanded, and its limits; empty: unknown.
struct CommandReading {
  const bla::Parameter* parameter = nullptr; ///< 0x08, 0x09 or 0x0A, as defined by the model
  std::optional<std::int64_t> low{}, high{};
};

struct MotionPlan {
  Plan plan;                                 ///< of 0x00, 0x01 or 0x02: checked by the guard
  const bla::Parameter* parameter = nullptr; ///< the commanded register
  std::vector<Waypoint> course; ///< one target, or those of a wiggle, which ends where it began
  Duration duration{};
  bool by_servo_id = false;
  std::array<CommandReading, 3> readings{}; ///< angle, speed, torque
  std::vector<bla::Fault> faults{};         ///< warnings and failures present before
  Duration timeout{};     ///< 0x27: after this time without a command the servo acts by 0x26
  Duration period{};      ///< from one command to the next
  Duration longest_gap{}; ///< the limit for the next one, whatever is still unanswered

  [[nodiscard]] const Servo& servo() const { return plan.before.servo; }

  [[nodiscard]] bool is_angle() const { return parameter->address == bla::address::command_angle; }

  [[nodiscard]] bool wiggles() const { return course.size() > 1; }

  /// The target at this time after the first command.
  [[nodiscard]] std::int64_t target_at(Duration after) const;

  /// The last target before the end.
  [[nodiscard]] std::int64_t last_target() const { return course.back().raw; }

  /// The settings that the plan depends on, as read: they must still hold at the start.
  [[nodiscard]] bla::Values conditions() const;
};

/// The registers that the plan depends on. Errors: commands that this servo refuses in any state:
/// no_profile, unsupported, out_of_range.
[[nodiscard]] Result<std::vector<const bla::Parameter*>>
registers_to_command(const CommandWanted& wanted, const Servo& servo);

/// `before` holds registers_to_command(); `profiles` outlives the plan. Errors: why `before` is
/// incomplete; cross_check: the servo's present settings prevent the command (0x20, 0x25, 0x26),
/// its limits (0x38-0x3D) are narrower, its timeout (0x27) is too short to be met over a bus;
/// usage, if ArrayCommand cannot represent the value exactly.
[[nodiscard]] Result<MotionPlan> plan_command(const CommandWanted& wanted, Snapshot before,
                                              const bla::Profiles& profiles);

/// The question to the user beforehand: from where to where, for how long, and what follows.
[[nodiscard]] std::string question_to_command(const MotionPlan& plan);

/// The servo's own behaviour once the commands end (4.19): "1000 ms after the last command the
/// output goes off". `now`: 0x26 and 0x27 if they were read since.
[[nodiscard]] std::string after_commands(const MotionPlan& plan, const bla::Values& now = {});

} // namespace blactl::fleet
