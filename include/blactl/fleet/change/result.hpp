#pragma once
// How the change of one servo ended.

#include "blactl/fleet/change/goal.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// The settings of a servo that has just started, complete: what its ROM holds.
struct RomReading {
  bla::Values values{};
  Time started{};                ///< by an uptime that was told after the last value
  std::chrono::seconds uptime{}; ///< that uptime
};

struct ChangeResult {
  Servo servo;          ///< as it was identified; its servo ID as it was read last
  bla::Values before{}; ///< what was read before anything was changed
  bla::Values now{};    ///< what is shown and no setting, as it was read again after the changes
  std::vector<RegisterChange> changes{};
  std::optional<std::int64_t> mode_before{}, mode_after{}; ///< as Plan
  std::vector<Warning> warnings{};                         ///< as Plan
  bool was_begun = false;      ///< by a job; else it is a plan that is shown
  bool saves = false;          ///< SAVE is part of it: all of RAM goes to ROM
  bool was_sent = false;       ///< a request that changes the servo has left, or may have
  bool may_have_saved = false; ///< SAVE has left, and nothing proves that it was not carried out
  bool was_restarted = false;  ///< SAVE or RestartNode was due, everything before went well
  bool is_verified = false;    ///< what it had to show it has shown
  bool saved = false;          ///< ROM was written, and the servo is back with these values
  std::optional<dronecan::NodeId> returned{};      ///< where it is back after its restart
  std::optional<dronecan::NodeId> node_id_after{}; ///< empty: not known, or it is away
  std::optional<RomReading> rom{};                 ///< after SAVE, where it is as expected, and
                                                   ///< where ROM was to be proven
  std::size_t values_read = 0;                     ///< and compared, at the end
  Duration duration{};          ///< from the request to restart until it was back
  std::optional<Error> error{}; ///< beside those of single changes

  /// All that went wrong, in the order in which it happened.
  [[nodiscard]] std::vector<Error> errors() const;

  [[nodiscard]] bool is_done() const { return !error && is_verified; }

  /// What it holds now, as far as is known; of a plan, what it would hold. What changes by itself
  /// or by the changes is known only where it was read again.
  [[nodiscard]] bla::Values after() const;
};

/// What came of one goal, in however many rounds: exit status, text and JSON derive from it.
struct GoalResult {
  Goal goal;
  Need need = Need::nothing;
  /// As it is planned; then what came of it, from what the servo held at first to what it holds.
  ChangeResult change{};
  bool is_done = false;             ///< it holds the goal, proven as far as that is asked
  std::optional<bool> rom_proven{}; ///< empty: that was not asked
  std::vector<Error> errors{};

  [[nodiscard]] const Servo& servo() const { return change.servo; }

  /// A register held something else than the goal names.
  [[nodiscard]] bool has_differences() const;
};

/// The result of a plan that is only shown (--dry-run).
[[nodiscard]] ChangeResult as_planned(const Plan& plan);

} // namespace blactl::fleet
