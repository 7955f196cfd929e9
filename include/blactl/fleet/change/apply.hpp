#pragma once
// Brings servos to what is wanted of each, with no more writing and restarting than that takes
// (contract, section 6): RAM and ROM in the end hold it, and that is proven.

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/fleet_change.hpp"
#include "blactl/fleet/change/result.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// What one servo shall hold.
struct Goal {
  dronecan::NodeId id; ///< where it is
  std::string name{};  ///< for people; may be empty
  std::vector<bla::Assignment> set{};
  bool saves = true; ///< in ROM, too
};

/// What has to be done for it.
enum class Need : std::uint8_t {
  nothing, ///< RAM holds it, and so does ROM as far as that is asked
  prove,   ///< RAM holds it; whether ROM does only a restart tells
  save,    ///< RAM holds it, ROM is known to hold something else
  write,   ///< RAM holds something else
};
[[nodiscard]] std::string_view name(Need need);

/// What came of one goal.
struct GoalResult {
  Goal goal;
  Need need = Need::nothing;
  Servo servo;                                             ///< as it was identified
  std::vector<RegisterChange> changes{};                   ///< all that is wished, by address
  std::optional<std::int64_t> mode_before{}, mode_after{}; ///< 0x37: the unit of 0x36
  std::vector<Warning> warnings{};
  bool is_done = false;
  bool was_begun = false;
  bool saved = false;                ///< ROM was written, and the servo is back with these values
  std::optional<bool> is_verified{}; ///< ROM was proven; empty: that was not asked
  std::optional<dronecan::NodeId> node_id_after{}; ///< empty: not known, or it is away
  Duration duration{};                             ///< of its restarts
  std::vector<Error> errors{};

  [[nodiscard]] bool has_differences() const;
};

/// First prepare(), then carry_out().
class Apply {
 public:
  struct Options {
    FleetChange::Options change{};
    bool trusts_ram = false; ///< equal RAM is enough: nothing is restarted to prove ROM
    /// What the ROM of a servo holds, if that was proven and the servo has run on since; else
    /// empty.
    std::function<std::optional<bla::Values>(const Servo& servo)> proven_rom{};
  };

  /// All references outlive this. The session has searched the bus (Discovery::find_all, with the
  /// static node IDs).
  Apply(Session& session, const bla::Profiles& profiles, state::AllocationStore& table,
        Options options)
      : session_(session), profiles_(profiles), table_(table), options_(std::move(options)),
        change_(session, profiles, table, options_.change) {}

  /// Reads the servos, and judges what each needs; nobody is changed if one refuses. Errors, all
  /// of them: as FleetChange::prepare(); what ends a session stands alone.
  [[nodiscard]] std::vector<Error> prepare(std::vector<Goal> goals);

  /// The one question before all of it; empty: nothing has to be asked.
  [[nodiscard]] std::string question() const { return change_.question(); }

  [[nodiscard]] const FleetChange& change() const { return change_; }

  /// Errors: why it did not begin or go on; what went wrong with single servos is in results().
  [[nodiscard]] std::vector<Error> carry_out();

  /// In the order of the goals, after prepare(): what is planned, then what came of it.
  [[nodiscard]] const std::vector<GoalResult>& results() const { return results_; }

 private:
  using Snapshots = std::vector<Snapshot>;

  [[nodiscard]] Result<Snapshots> read(std::span<const std::size_t> goals);
  [[nodiscard]] Need need(const Goal& goal, const Snapshot& held,
                          const std::optional<bla::Values>& rom) const;
  [[nodiscard]] std::vector<Error> prepare(std::span<const std::size_t> goals, FleetChange& change,
                                           std::vector<std::size_t>& units);
  void conclude(const FleetChange& change, std::span<const std::size_t> units);
  [[nodiscard]] std::vector<Error> write_what_rom_lacks();
  void look_back();

  Session& session_;
  const bla::Profiles& profiles_;
  state::AllocationStore& table_;
  Options options_;
  FleetChange change_;
  std::vector<GoalResult> results_;
  std::vector<std::size_t> begun_; ///< the goals behind the units of change_
};

} // namespace blactl::fleet
