#pragma once
// Why nobody, or nobody in particular, can be asked under a node ID: absent, silent, or doubled.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"

namespace blactl::fleet {

/// That no servo on the bus matches: not_found.
[[nodiscard]] Error nothing_matches(const Roster& roster, const Selector& selector);

/// That no BLA servo is there, and who is: not_found.
[[nodiscard]] Error no_servo(const Roster& roster);

/// That a recording holds nothing of this node: not_recorded.
[[nodiscard]] Error unrecorded(dronecan::NodeId id);

/// That two units use this node ID, named by their unique IDs where both are known:
/// duplicate_node_id. What is read from it may be of either, what is written goes to both.
[[nodiscard]] Error doubled(const Roster& roster, dronecan::NodeId id);

/// That nobody answers under this node ID: timeout where somebody was heard, else not_found.
[[nodiscard]] Error silent(const Roster& roster, dronecan::NodeId id);

} // namespace blactl::fleet
