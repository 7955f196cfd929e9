#pragma once
// How results of goals begin, and grow from round to round.

#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/result.hpp"

namespace blactl::fleet {

/// Compares the goal with the present values; a plan may add to it.
[[nodiscard]] GoalResult compared(Goal goal, Need need, const Snapshot& held);

/// The result of all rounds. `earlier`: the same servo, before its last round.
[[nodiscard]] ChangeResult merged(ChangeResult earlier, const ChangeResult& last);

} // namespace blactl::fleet
