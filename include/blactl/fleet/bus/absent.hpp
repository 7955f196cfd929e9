#pragma once
// What is said of those who are meant and are not there.

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"

namespace blactl::fleet {

/// That no servo on the bus matches: not_found.
[[nodiscard]] Error nothing_matches(const Roster& roster, const Selector& selector);

/// That no BLA servo is there, and who is: not_found.
[[nodiscard]] Error no_servo(const Roster& roster);

/// That a recording holds nothing of this node: not_recorded.
[[nodiscard]] Error unrecorded(dronecan::NodeId id);

} // namespace blactl::fleet
