#pragma once
// Changes several servos, each to its wanted state: all at once, except those that wait for a node
// ID that another one still has (id_moves.hpp), or for a servo ID. Used by Change only.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/id_moves.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/fleet/change/survey.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// The wanted change of one servo, and its values when that was planned.
struct UnitTask {
  Snapshot before; ///< holds registers_needed()
  Wanted wanted;
};

struct UnitChange {
  dronecan::UniqueId unique_id{};
  Wanted wanted;
  Plan plan;                          ///< from the initial to the wanted state
  dronecan::NodeId now;               ///< last seen node ID
  bool is_done = false;               ///< it holds the goal, proven as far as required
  std::optional<ChangeResult> last{}; ///< of its last restart or write; empty: not begun
  bool has_made_way = false;          ///< it is on a temporary ID
  std::set<std::int64_t> servo_ids{}; ///< that its RAM or ROM holds, or may hold
  std::optional<std::int64_t> temporary_servo_id{}; ///< that it is saved with, for others

  /// The static node ID stored by SAVE; empty: none, or its present one.
  [[nodiscard]] std::optional<dronecan::NodeId> static_node_id() const;

  /// The servo ID stored by SAVE; empty: none.
  [[nodiscard]] std::optional<std::int64_t> saved_servo_id() const;

  [[nodiscard]] bool has_failed() const { return last && !last->is_done(); }
};

/// Call prepare(), then carry_out().
class Rounds {
 public:
  struct Options {
    Manner manner{};
    bool stops_at_failure = false; ///< no round begins after one with a failed unit
    bool knows_ids = false;        ///< the bus was searched, with the static node IDs
  };

  /// Called for every proven move of a node ID.
  using Hook = std::function<void(const IdMove& move)>;

  /// Both references outlive this.
  Rounds(Session& session, const bla::Profiles& profiles, Options options)
      : session_(session), profiles_(profiles), options_(std::move(options)) {}

  /// Plans, and checks each servo in its present state; if one refuses none is changed. Errors, all
  /// of them: as plan_id_moves(), make_plan(), conflict() and forbidden(); one that ends a session
  /// is the only one.
  [[nodiscard]] std::vector<Error> prepare(std::vector<UnitTask> tasks);

  /// The one question before everything; empty: none needed.
  [[nodiscard]] std::string question() const;

  /// Notes for the user: servos with unknown IDs that may be the assigned ones, those that make way
  /// for others first, and those whose IDs are taken over.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// Checks again, after a question; then carries everything out. A unit that fails stops those
  /// that wait for its node ID. The settings of all of them are recorded before the first one is
  /// changed. Errors: why it did not begin or go on; those of single servos are in units().
  [[nodiscard]] std::vector<Error> carry_out(const Hook& hook);

  /// In the order of the tasks, after prepare().
  [[nodiscard]] const std::vector<UnitChange>& units() const { return units_; }

 private:
  [[nodiscard]] std::string given_ids() const;

  /// One unit in one round; without a move it stays on its node ID.
  struct Step {
    std::size_t unit;
    std::optional<IdMove> move{};
    std::optional<std::int64_t> temporary_servo_id{}; ///< with which it makes way for others
  };

  using Round = std::vector<Step>;
  using Sights = std::map<std::size_t, Snapshot>; ///< by unit

  // Planning (rounds.cpp).
  [[nodiscard]] std::vector<Error> make_plans(std::vector<UnitTask> tasks);
  [[nodiscard]] Result<Survey> look_around();
  [[nodiscard]] std::vector<Error> make_rounds();
  void add_rounds(const IdRounds& moves);
  [[nodiscard]] Result<void> learn_ids();
  [[nodiscard]] Result<state::AllocationStore*> table();
  void note_takeovers();
  [[nodiscard]] std::vector<Error> check_ids(const Survey& survey);
  [[nodiscard]] std::vector<Error> check_unread(const Survey& survey, std::span<const Plan> plans);
  [[nodiscard]] std::vector<Error> check() const;
  [[nodiscard]] std::vector<Plan> plans() const;

  // Servo IDs that change hands (servo_id_moves.cpp).
  void learn_servo_ids(const Survey& survey);
  [[nodiscard]] std::vector<Error> make_way(const Survey& survey);
  [[nodiscard]] std::optional<Error> take_temporary(Step& step, const Survey& survey) const;
  [[nodiscard]] std::optional<Error> put_first(std::size_t number, const Survey& survey);
  [[nodiscard]] std::pair<std::size_t, std::size_t> rounds_of(std::size_t unit) const;
  [[nodiscard]] bool is_waited_for(std::size_t unit) const;
  [[nodiscard]] bool waits_for_servo_id(const UnitChange& unit) const;
  [[nodiscard]] bool may_be_held(std::int64_t servo_id, const UnitChange& except) const;
  [[nodiscard]] std::optional<std::int64_t> free_servo_id(const UnitChange& unit,
                                                          const Survey& survey) const;
  [[nodiscard]] std::optional<std::int64_t> servo_id_of(const Step& step) const;
  [[nodiscard]] Result<Wanted> wanted(const Step& step) const;
  [[nodiscard]] std::optional<Error> servo_id_not_free(const Step& step) const;

  // Carrying out (carry_out_rounds.cpp).
  [[nodiscard]] bool is_free(const IdMove& move) const;
  [[nodiscard]] Error why_not_free(const IdMove& move) const;
  [[nodiscard]] std::optional<dronecan::NodeId> place(const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] Result<void> put_as_they_are();
  [[nodiscard]] Result<void> give_back();
  [[nodiscard]] Result<void> put(const Round& round);
  [[nodiscard]] Round ready(const Round& round);
  [[nodiscard]] Result<Sights> look_again(const Round& steps);
  [[nodiscard]] std::optional<Error> changed_since(const UnitChange& unit,
                                                   const Snapshot& before) const;
  [[nodiscard]] Result<Plan> plan(const Step& step, const Sights& sights);
  [[nodiscard]] std::vector<Error> carry_out_rounds(const Hook& hook);
  [[nodiscard]] std::vector<Error> carry_out_each(const Hook& hook);
  [[nodiscard]] std::vector<Error> carry_out(const Round& round, const Hook& hook);
  [[nodiscard]] static std::optional<Error> misplaced(const IdMove& move,
                                                      const ChangeResult& result);
  void conclude(const Step& step, ChangeResult result, const Hook& hook);
  void fail(const Step& step, Error error);

  Session& session_;
  const bla::Profiles& profiles_;
  Options options_;
  std::optional<state::AllocationStore> table_; ///< opened when an ID is assigned
  std::vector<UnitChange> units_;
  std::vector<Round> rounds_;
  std::vector<state::AllocationEntry> absent_; ///< promised to units that are away
  std::vector<std::string> notes_;
  Time surveyed_ = never;                 ///< when the IDs of the others were asked
  std::map<dronecan::NodeId, Time> left_; ///< IDs from which a unit has moved, and when
};

} // namespace blactl::fleet
