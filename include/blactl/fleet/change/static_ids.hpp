#pragma once
// Goals that give units on the bus static node IDs, and nothing else.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/goal.hpp"
#include "blactl/fleet/change/let_in.hpp"
#include "blactl/state/allocation_store.hpp"

#include <vector>

namespace blactl::fleet {

/// The goals that give units their wanted IDs.
struct StaticGoals {
  std::vector<Goal> goals{};   ///< by wanted ID
  std::vector<Error> errors{}; ///< for missing units
};

/// `not_let_in`: from let_in(). The roster knows the static node IDs.
[[nodiscard]] StaticGoals static_goals(const Roster& roster, const bla::Profiles& profiles,
                                       std::vector<state::AllocationStore::Wish> wishes,
                                       const NotLetIn& not_let_in);

} // namespace blactl::fleet
