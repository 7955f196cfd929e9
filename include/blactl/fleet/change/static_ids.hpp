#pragma once
// Goals that give units on the bus static node IDs, and nothing else.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/fleet/change/goal.hpp"
#include "blactl/state/allocation_store.hpp"

#include <span>
#include <vector>

namespace blactl::fleet {

/// The present ID of each of these nodes, as a wish. Errors: duplicate_node_id; timeout (its unique
/// ID is unknown).
[[nodiscard]] Result<std::vector<state::AllocationStore::Wish>>
ids_as_they_are(const Roster& roster, std::span<const dronecan::NodeId> nodes);

/// The goals that give units their wanted IDs.
struct StaticGoals {
  std::vector<Goal> goals{};   ///< by wanted ID
  std::vector<Error> errors{}; ///< for missing units
};

/// `not_let_in`: from let_in(). The roster knows the static node IDs.
[[nodiscard]] StaticGoals static_goals(const Roster& roster, const bla::Profiles& profiles,
                                       std::vector<state::AllocationStore::Wish> wishes,
                                       const NotLetIn& not_let_in);

/// Enters the IDs that units have as wished already; those that are given are entered on the way.
/// Errors: as AllocationStore::enter().
[[nodiscard]] Result<void> enter_kept(state::AllocationStore& table,
                                      std::span<const state::AllocationStore::Wish> kept,
                                      WallTime now);

} // namespace blactl::fleet
