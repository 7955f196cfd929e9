#pragma once
// The plan of a change to one servo, checked before the first frame that changes anything.

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/register_change.hpp"
#include "blactl/fleet/change/save_restart_job.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The wanted change, for every servo of a command.
struct Wanted {
  std::vector<bla::Assignment> assignments{};
  bool erase = false;
  bool keep_ids = false; ///< 0x45 and 0x46 survive ERASE
  /// Those that an earlier ERASE was to keep, and took from RAM when it broke off.
  bla::Values lost_ids{};
  std::optional<RestartKind> restart{};
  bool proves_rom = false; ///< after a plain restart the configuration is read: the contents of ROM
  std::optional<std::int64_t> rom_servo_id{}; ///< that a plain restart brings back, as far as known
  Time told_until = never;               ///< until then it was told what a restart takes from RAM
  std::vector<bla::Address> also_read{}; ///< shown in addition to the changes
  bool never_while_driven = false; ///< whatever it changes: contract, section 4, of whole commands

  /// Whether it concerns whole servos, not single registers.
  [[nodiscard]] bool is_about_whole_servo() const { return assignments.empty(); }
};

/// A warning about a change that is not refused.
struct Warning {
  std::string code; ///< "leave_at_default"
  std::string text;
};

/// The change of one servo from its present to its wanted settings: erased first, then written,
/// then restarted.
struct Plan {
  Snapshot before;
  bool erase = false;
  bool keep_ids = false;
  std::vector<RegisterChange> changes{};
  std::optional<RestartKind> restart{};
  bool proves_rom = false;                    ///< as in Wanted
  bool never_while_driven = false;            ///< as in Wanted
  bool may_change_all = false;                ///< any setting, in no order that is known
  std::optional<std::int64_t> rom_servo_id{}; ///< likewise
  Time told_until = never;                    ///< likewise
  std::vector<bla::Address> shown{};          ///< Wanted::also_read
  /// The configuration afterwards; empty if unknown or not needed: a plain restart loads ROM.
  bla::Values expected{};
  /// 0x37 before and after, on which the unit of 0x36 depends; empty if not read.
  std::optional<std::int64_t> mode_before{}, mode_after{};
  std::vector<Warning> warnings{};

  /// The new static node ID; empty: none, or the present one.
  [[nodiscard]] std::optional<dronecan::NodeId> given_node_id() const;

  /// The new permanent servo ID, if not 0; empty: none.
  [[nodiscard]] std::optional<std::int64_t> given_servo_id() const;

  /// The servo IDs that it will have in the meantime and in the end, as far as known.
  [[nodiscard]] std::vector<std::int64_t> next_servo_ids() const;

  /// What it does to a register; null: it leaves it as it is.
  [[nodiscard]] const RegisterChange* change_of(bla::Address address) const;

  /// Whether requests will be sent that change the servo.
  [[nodiscard]] bool acts() const;

  /// Whether it can move the shaft or release the load, or is never done while others drive.
  [[nodiscard]] bool waits_for_driver() const;
};

/// The registers that the plan depends on. Errors: changes that this servo refuses in any state:
/// no_profile, unsupported, read_only, out_of_range.
[[nodiscard]] Result<std::vector<const bla::Parameter*>> registers_needed(const Wanted& wanted,
                                                                          const Servo& servo);

/// `before` holds registers_needed(). Errors: why it does not; usage (0x36 in a unit that
/// contradicts 0x37); no_profile (ERASE, if the defaults are unknown); cross_check (a command that
/// the servo's settings disable); state (SAVE, if a restart has just reset RAM).
[[nodiscard]] Result<Plan> make_plan(const Wanted& wanted, Snapshot before,
                                     const bla::Profiles& profiles);

/// The reason why several servos at once, or any, must not be changed so; empty: they may. Errors:
/// usage (SAVE of what is not a setting), duplicate_node_id, duplicate_servo_id (one ID for all).
[[nodiscard]] std::optional<Error> refuse_together(const Wanted& wanted,
                                                   std::span<const dronecan::NodeId> servos);

/// The one question before everything; empty: none needed.
[[nodiscard]] std::string question(std::span<const Plan> plans);

} // namespace blactl::fleet
