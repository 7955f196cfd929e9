#pragma once
// Static node IDs for units on the bus, wherever those are: a change of the fleet in which each
// servo gets nothing but its ID.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/fleet_change.hpp"
#include "blactl/state/allocation_store.hpp"

#include <expected>
#include <map>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Makes the node IDs that are wished static. First prepare(), then carry_out().
class StaticIds {
 public:
  using Wish = state::AllocationStore::Wish;

  /// All references outlive this. The session has searched the bus (Discovery::find_all, with the
  /// static node IDs).
  StaticIds(Session& session, const bla::Profiles& profiles, state::AllocationStore& table,
            const FleetChange::Options& options)
      : session_(session), profiles_(profiles), table_(table), manner_(options.manner),
        change_(session, profiles, table, options) {}

  /// The present ID of each of these nodes, as a wish. Errors: duplicate_node_id.
  [[nodiscard]] Result<std::vector<Wish>>
  as_they_are(std::span<const dronecan::NodeId> nodes) const;

  /// Where units ask for node IDs, those for which one is wished are given one for the time being:
  /// lives until they are there. Who is still away then is for prepare() to tell.
  /// Errors: those that end a session, and those of the table.
  [[nodiscard]] Result<void> let_in(std::span<const Wish> wishes);

  /// Reads the servos, and makes of the wishes what change() will carry out. Errors, all of them:
  /// as FleetChange::prepare(); what ends a session stands alone.
  [[nodiscard]] std::vector<Error> prepare(std::span<const Wish> wishes);

  /// After prepare().
  [[nodiscard]] FleetChange& change() { return change_; }

 private:
  using Tasks = std::expected<std::vector<UnitTask>, std::vector<Error>>;

  [[nodiscard]] bool is_there(const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] Error absence(const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] std::vector<Error> judge(std::span<const Wish> wishes) const;
  [[nodiscard]] Tasks read(std::span<const Wish> wishes);

  Session& session_;
  const bla::Profiles& profiles_;
  state::AllocationStore& table_;
  Manner manner_;
  FleetChange change_;
  std::map<dronecan::UniqueId, Error> not_let_in_; ///< why they have no ID though they asked
};

} // namespace blactl::fleet
