#pragma once
// The result of the change of one servo.

#include "blactl/fleet/change/goal.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// The complete settings of a servo that has just started: the contents of its ROM.
struct RomReading {
  bla::Values values{};
  Time started{};                ///< by an uptime received after the last value
  std::chrono::seconds uptime{}; ///< that uptime
};

struct ChangeResult {
  Servo servo;          ///< as identified; its servo ID as last read
  bla::Values before{}; ///< values read before anything was changed
  bla::Values now{};    ///< shown values that are not settings, read again after the changes
  std::vector<RegisterChange> changes{};
  std::optional<std::int64_t> mode_before{}, mode_after{}; ///< as in Plan
  std::vector<Warning> warnings{};                         ///< as in Plan
  bool was_begun = false;        ///< by a job; false: a plan that is shown
  bool saves = false;            ///< SAVE is part of it: all of RAM goes to ROM
  bool was_sent = false;         ///< a request that changes the servo has left, or may have
  bool may_have_changed = false; ///< and was carried out, as far as known
  bool may_have_saved = false;   ///< SAVE has left, or another node's, and may have succeeded
  bool is_doubted = false;       ///< what RAM holds now is not known: doubt()
  bool was_restarted = false;    ///< SAVE or RestartNode was due, and all before succeeded
  bool is_verified = false;      ///< everything required was proven
  bool saved = false;            ///< ROM was written, and the servo is back with these values
  std::optional<dronecan::NodeId> returned{};      ///< its node ID after the restart
  std::optional<dronecan::NodeId> node_id_after{}; ///< empty: unknown, or it is away
  bool is_rom_unread = false;                      ///< it is back, and could not read its ROM
  bool is_read_again = false; ///< `rom` was, after a restart that is not ours: no lasting proof
  std::optional<RomReading> rom{}; ///< after SAVE, if as expected, and if ROM was to be proven
  std::size_t values_read = 0;     ///< and compared, at the end
  Time looked_at{};                ///< when all of that was last checked to hold
  std::uint32_t boots = 0;         ///< Member::boots at that time
  std::optional<dronecan::Health> health{}; ///< likewise; empty: it has not told it
  Duration duration{};                      ///< from the request to restart until it was back
  std::optional<Error> error{};             ///< in addition to those of single changes

  /// The written values may be gone: the servo restarted, or another node wrote to it.
  void doubt();

  /// All errors, in the order in which they occurred.
  [[nodiscard]] std::vector<Error> errors() const;

  [[nodiscard]] bool is_done() const { return !error && is_verified; }

  /// Its present values, as far as known; for a plan, the values it would have. Values that change
  /// by themselves or by the changes are only known if read again.
  [[nodiscard]] bla::Values after() const;
};

/// The result of one goal, over all rounds: exit status, text and JSON derive from it.
struct GoalResult {
  Goal goal;
  Need need = Need::nothing;
  /// The plan; then the result, from the first to the last values of the servo.
  ChangeResult change{};
  bool is_done = false;             ///< it holds the goal, proven as far as required
  std::optional<bool> rom_proven{}; ///< empty: not required
  std::vector<Error> errors{};

  [[nodiscard]] const Servo& servo() const { return change.servo; }

  /// Whether a register had another value than the goal's.
  [[nodiscard]] bool has_differences() const;
};

/// The result of a plan that is only shown (--dry-run).
[[nodiscard]] ChangeResult as_planned(const Plan& plan);

} // namespace blactl::fleet
