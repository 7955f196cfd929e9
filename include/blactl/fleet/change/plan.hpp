#pragma once
// What is going to be done to one servo: judged before the first frame that changes anything.

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/register_change.hpp"
#include "blactl/fleet/change/restart_job.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// What a command wants of every servo that it is about.
struct Wanted {
  std::vector<bla::Assignment> assignments{};
  bool erase = false;
  bool keep_ids = false; ///< 0x45 and 0x46 outlive the erasing
  std::optional<RestartKind> restart{};
  bool proves_rom = false; ///< after a mere restart the configuration is read: what ROM holds
  std::vector<bla::Address> also_read{}; ///< what is to be shown beside the changes

  /// Changed are whole servos, not single registers.
  [[nodiscard]] bool is_about_whole_servo() const { return assignments.empty(); }
};

/// What a person should know before a change that is not refused.
struct Warning {
  std::string code; ///< "leave_at_default"
  std::string text;
};

/// One servo from what it holds to what it shall hold: erased first, then written, then restarted.
struct Plan {
  Snapshot before;
  bool erase = false;
  bool keep_ids = false;
  std::vector<RegisterChange> changes{};
  std::optional<RestartKind> restart{};
  bool proves_rom = false;           ///< as Wanted
  std::vector<bla::Address> shown{}; ///< as Wanted::also_read
  /// The configuration afterwards; empty where nobody can know or asks: a mere restart brings what
  /// ROM holds.
  bla::Values expected{};
  /// 0x37 before and after, which the unit of 0x36 depends on; empty where it was not read.
  std::optional<std::int64_t> mode_before{}, mode_after{};
  std::vector<Warning> warnings{};

  /// The static node ID that the servo will have; empty: it gets none, or has it already.
  [[nodiscard]] std::optional<dronecan::NodeId> given_node_id() const;

  /// The servo ID other than 0 that it will have for good; empty: none is given.
  [[nodiscard]] std::optional<std::int64_t> given_servo_id() const;

  /// Something will be sent that changes the servo.
  [[nodiscard]] bool acts() const;

  /// It can move the shaft or let go of the load.
  [[nodiscard]] bool moves() const;
};

/// The registers whose values the plan rests on. Errors: what this servo refuses, whatever it
/// holds: no_profile, unsupported, read_only, out_of_range.
[[nodiscard]] Result<std::vector<const bla::Parameter*>> registers_needed(const Wanted& wanted,
                                                                          const Servo& servo);

/// How much of them must be proven: what RAM has lost SAVE must not make lasting.
[[nodiscard]] ReadJob::Proof proof_needed(const Wanted& wanted);

/// `before` holds registers_needed(). Errors: why it does not; usage (0x36 in the unit that 0x37
/// does not take); no_profile (ERASE, where the defaults are not known); cross_check (a command
/// that the servo does not take as it is switched); state (SAVE, where a restart has just ended
/// what was in RAM only).
[[nodiscard]] Result<Plan> make_plan(const Wanted& wanted, Snapshot before,
                                     const bla::Profiles& profiles);

/// Why this must not be done to several servos at once, or to any; empty: it may. Errors: usage
/// (SAVE of what is no setting), duplicate_node_id, duplicate_servo_id (one ID for all).
[[nodiscard]] std::optional<Error> refuse_together(const Wanted& wanted,
                                                   std::span<const dronecan::NodeId> servos);

/// The one question before all of it; empty: nothing has to be asked.
[[nodiscard]] std::string question(std::span<const Plan> plans);

} // namespace blactl::fleet
