#pragma once
// Changes several servos, each to what is wanted of it: all at once, save those that wait for a
// node ID which another one still has (id_moves.hpp). Change is the only one who uses it.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/id_moves.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// What is wanted of one servo, and what it held when that was judged.
struct UnitTask {
  Snapshot before; ///< holds registers_needed()
  Wanted wanted;
};

/// What came of one unit.
struct UnitChange {
  dronecan::UniqueId unique_id{};
  Wanted wanted;
  Plan plan;                          ///< from where it was to what is wanted
  dronecan::NodeId now;               ///< where it was seen last
  bool is_done = false;               ///< it holds what is wanted, proven as far as that is asked
  std::optional<ChangeResult> last{}; ///< of its last restart or writing; empty: it was not begun
  bool has_made_way = false;          ///< it is on an ID that it has for the time being only

  /// The static node ID that SAVE gives it; empty: none, or the one that it is on already.
  [[nodiscard]] std::optional<dronecan::NodeId> static_node_id() const;

  [[nodiscard]] bool has_failed() const { return last && !last->is_done(); }
};

/// First prepare(), then carry_out().
class Rounds {
 public:
  struct Options {
    Manner manner{};
    bool stops_at_failure = false; ///< no round begins after one in which a unit failed
    bool knows_ids = false;        ///< the bus was searched, with the static node IDs
  };

  /// Called for every move of a node ID that is proven.
  using Hook = std::function<void(const IdMove& move)>;

  /// Both references outlive this.
  Rounds(Session& session, const bla::Profiles& profiles, Options options)
      : session_(session), profiles_(profiles), options_(std::move(options)) {}

  /// Plans, and judges each servo as it is now; nobody is changed if one refuses. Errors, all of
  /// them: as plan_id_moves(), make_plan(), conflict() and forbidden(); what ends a session stands
  /// alone.
  [[nodiscard]] std::vector<Error> prepare(std::vector<UnitTask> tasks);

  /// The one question before all of it; empty: nothing has to be asked.
  [[nodiscard]] std::string question() const;

  /// What a person should know: who did not tell its IDs and may have those that are given, who
  /// makes way for others first, and whose IDs are taken over.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// Judges once more, after a question; then carries all out. A unit that fails stops those that
  /// wait for its node ID. What all of them hold is recorded before the first one is changed.
  /// Errors: why it did not begin or go on; what went wrong with single
  /// servos is in units().
  [[nodiscard]] std::vector<Error> carry_out(const Hook& hook);

  /// In the order of the tasks, after prepare().
  [[nodiscard]] const std::vector<UnitChange>& units() const { return units_; }

 private:
  /// One unit in one round; without a move it stays on its node ID.
  struct Step {
    std::size_t unit;
    std::optional<IdMove> move;
  };

  using Round = std::vector<Step>;
  using Sights = std::map<std::size_t, Snapshot>; ///< by unit

  [[nodiscard]] std::vector<Error> make_plans(std::vector<UnitTask> tasks);
  [[nodiscard]] std::vector<Error> make_rounds();
  [[nodiscard]] Result<void> learn_ids();
  [[nodiscard]] Result<state::AllocationStore*> table();
  void note_takeovers(const std::vector<state::AllocationEntry>& absent);
  [[nodiscard]] std::vector<Error> check_ids();
  [[nodiscard]] std::vector<Error> check() const;
  [[nodiscard]] bool is_free(const IdMove& move) const;
  [[nodiscard]] std::optional<dronecan::NodeId> place(const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] Result<void> put_as_they_are();
  [[nodiscard]] Result<void> put(const Round& round);
  [[nodiscard]] Round ready(const Round& round);
  [[nodiscard]] Result<Sights> look_again(const Round& steps);
  [[nodiscard]] Result<Plan> plan(const Step& step, const Sights& sights);
  [[nodiscard]] std::vector<Error> carry_out_rounds(const Hook& hook);
  [[nodiscard]] std::vector<Error> carry_out(const Round& round, const Hook& hook);
  void conclude(const Step& step, ChangeResult result, const Hook& hook);
  void fail(const Step& step, Error error);

  Session& session_;
  const bla::Profiles& profiles_;
  Options options_;
  std::optional<state::AllocationStore> table_; ///< once an ID is given
  std::vector<UnitChange> units_;
  std::vector<Round> rounds_;
  std::vector<std::string> notes_;
  std::map<dronecan::NodeId, Time> left_; ///< IDs from which a unit has moved, and when
};

} // namespace blactl::fleet
