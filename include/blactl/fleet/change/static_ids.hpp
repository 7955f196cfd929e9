#pragma once
// Static node IDs for units on the bus, wherever those are: goals that name nothing but the ID.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/goal.hpp"
#include "blactl/fleet/change/let_in.hpp"
#include "blactl/state/allocation_store.hpp"

#include <span>
#include <vector>

namespace blactl::fleet {

/// The present ID of each of these nodes, as a wish. Errors: duplicate_node_id; timeout (it did not
/// say who it is).
[[nodiscard]] Result<std::vector<state::AllocationStore::Wish>>
ids_as_they_are(const Roster& roster, std::span<const dronecan::NodeId> nodes);

/// The goals that give units the IDs wished for them.
struct StaticGoals {
  std::vector<Goal> goals{};   ///< by the IDs wished
  std::vector<Error> errors{}; ///< of units that are not there
};

/// `not_let_in`: as let_in() has it. The roster knows the static node IDs.
[[nodiscard]] StaticGoals static_goals(const Roster& roster, const bla::Profiles& profiles,
                                       std::vector<state::AllocationStore::Wish> wishes,
                                       const NotLetIn& not_let_in);

} // namespace blactl::fleet
