#pragma once
// Static node IDs for units on the bus, in the rounds of id_moves.hpp: the next round begins when
// everybody of the one before was seen on its new ID, saved and read again.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/carry_out.hpp"
#include "blactl/fleet/id_moves.hpp"
#include "blactl/fleet/plan.hpp"
#include "blactl/fleet/session.hpp"
#include "blactl/state/allocation_store.hpp"

#include <expected>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// What came of one unit.
struct StaticId {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId wish;
  dronecan::NodeId now;               ///< where it was seen last
  bool is_done = false;               ///< `wish` is in its ROM, and it is there
  std::optional<ChangeResult> last{}; ///< of its last move; empty: it was not begun
};

/// Makes the node IDs that are wished static. First prepare(), then carry_out().
class StaticIds {
 public:
  using Wish = state::AllocationStore::Wish;

  /// Called for every move that is proven.
  using Hook = std::function<void(const IdMove& move)>;

  /// All references outlive this. The session has searched the bus (Discovery::find_all, with the
  /// static node IDs).
  StaticIds(Session& session, const bla::Profiles& profiles, state::AllocationStore& table,
            Manner manner)
      : session_(session), profiles_(profiles), table_(table), manner_(std::move(manner)) {}

  /// The present ID of each of these nodes, as a wish. Errors: duplicate_node_id.
  [[nodiscard]] Result<std::vector<Wish>>
  as_they_are(std::span<const dronecan::NodeId> nodes) const;

  /// Where units ask for node IDs, those for which one is wished are given one for the time being:
  /// lives until they are there. Who is still away then is for prepare() to tell.
  /// Errors: those that end a session, and those of the table.
  [[nodiscard]] Result<void> let_in(std::span<const Wish> wishes);

  /// Plans the rounds, and judges each servo as it is now. Errors, all of them: as
  /// plan_id_moves(), make_plan() and forbidden(); what ends a session stands alone.
  [[nodiscard]] std::expected<void, std::vector<Error>> prepare(std::span<const Wish> wishes,
                                                                bool while_driven);

  /// The one question before all rounds; empty: nothing has to be asked.
  [[nodiscard]] std::string question() const;

  /// Those that make way for others first.
  [[nodiscard]] std::vector<IdMove> temporary() const;

  /// Judges once more, after a question; then carries the rounds out until one fails. Errors: why
  /// it did not go on; what went wrong with single servos is in units().
  [[nodiscard]] std::vector<Error> carry_out(const Hook& hook);

  /// By wished ID, after prepare().
  [[nodiscard]] const std::vector<StaticId>& units() const { return units_; }

 private:
  using Plans = std::expected<std::vector<Plan>, std::vector<Error>>;

  [[nodiscard]] bool is_there(const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] Error absence(const dronecan::UniqueId& unique_id) const;
  void explain_absences(std::span<const IdHolder> units, std::vector<Error>& errors) const;
  [[nodiscard]] std::vector<IdHolder> holders() const;
  [[nodiscard]] Result<state::NodeIds> promised() const;
  [[nodiscard]] Plans plans(std::span<const IdMove> moves);
  [[nodiscard]] std::vector<Error> check(std::span<const Plan> plans) const;
  [[nodiscard]] bool is_free(const IdMove& move) const;
  [[nodiscard]] std::vector<Error> check(std::span<const IdMove> round) const;
  [[nodiscard]] Result<void> put_as_they_are();
  [[nodiscard]] std::vector<Error> carry_out(std::span<const IdMove> round, const Hook& hook);
  void conclude(const IdMove& move, ChangeResult result, const Hook& hook);

  Session& session_;
  const bla::Profiles& profiles_;
  state::AllocationStore& table_;
  Manner manner_;
  bool while_driven_ = false;
  std::map<dronecan::UniqueId, Error> not_let_in_; ///< why they have no ID though they asked
  std::vector<Wish> wishes_;
  IdRounds rounds_;
  std::vector<Plan> judged_; ///< each unit from where it is to what is wished
  std::vector<StaticId> units_;
  std::map<dronecan::NodeId, Time> left_; ///< IDs from which a unit has moved, and when
};

} // namespace blactl::fleet
