#pragma once
// A command to the shaft of one servo for a bounded time: judged before the first frame that moves
// anything.

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

/// What the shaft of a servo shall do.
struct CommandWanted {
  std::optional<bla::Assignment> target{}; ///< of 0x00-0x02; empty: it wiggles, to show itself
  Duration duration = std::chrono::seconds(2);
  bool by_servo_id = false; ///< by ArrayCommand instead of 0x00-0x02 of the node
};

/// From a moment on, counted from the first command, this is commanded.
struct Waypoint {
  Duration from{};
  std::int64_t raw = 0;
};

/// What is read of a servo while it is commanded, and what it is told to stay within; empty: not
/// known.
struct CommandReading {
  const bla::Parameter* parameter = nullptr; ///< 0x08, 0x09 or 0x0A, as the model has it
  std::optional<std::int64_t> low{}, high{};
};

/// One servo that is going to be commanded.
struct CommandPlan {
  Plan plan;                                 ///< of 0x00, 0x01 or 0x02: what the guard judges
  const bla::Parameter* parameter = nullptr; ///< that one
  std::vector<Waypoint> course; ///< one, or those of a wiggle, which ends where it began
  Duration duration{};
  bool by_servo_id = false;
  std::array<CommandReading, 3> readings{}; ///< angle, speed, torque
  std::vector<bla::Fault> faults{};         ///< warnings and failures that were there before
  Duration timeout{};     ///< 0x27: without a command for so long the servo acts by 0x26
  Duration period{};      ///< from one command to the next
  Duration longest_gap{}; ///< the next one is sent by then, whatever is still unanswered

  [[nodiscard]] const Servo& servo() const { return plan.before.servo; }

  [[nodiscard]] bool is_angle() const { return parameter->address == bla::address::command_angle; }

  [[nodiscard]] bool wiggles() const { return course.size() > 1; }

  /// What is commanded so long after the first command.
  [[nodiscard]] std::int64_t target_at(Duration after) const;

  /// What it is commanded before its end.
  [[nodiscard]] std::int64_t last_target() const { return course.back().raw; }

  /// What it rests on, as it was read: that must still hold when it begins.
  [[nodiscard]] bla::Values conditions() const;
};

/// The registers that the plan rests on. Errors: what this servo refuses, whatever it holds:
/// no_profile, unsupported, out_of_range.
[[nodiscard]] Result<std::vector<const bla::Parameter*>>
registers_to_command(const CommandWanted& wanted, const Servo& servo);

/// `before` holds registers_to_command(); `profiles` outlives the plan. Errors: why it does not;
/// cross_check: the servo does not take it as it is switched (0x20, 0x25, 0x26), its limits
/// (0x38-0x3D) are narrower, its timeout (0x27) is too short to be fed over a bus; usage, where
/// ArrayCommand cannot tell it exactly.
[[nodiscard]] Result<CommandPlan> plan_command(const CommandWanted& wanted, Snapshot before,
                                               const bla::Profiles& profiles);

/// The question before it: from where to where, for how long, and what comes after it.
[[nodiscard]] std::string question_to_command(const CommandPlan& plan);

/// What the servo does by itself once the commands end (4.19): "1000 ms after the last command the
/// output goes off". `now`: 0x26 and 0x27 where they were read since.
[[nodiscard]] std::string after_commands(const CommandPlan& plan, const bla::Values& now = {});

} // namespace blactl::fleet
