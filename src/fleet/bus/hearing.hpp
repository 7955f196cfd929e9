#pragma once
// The frames that a session hears.

#include "blactl/can/bus.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <vector>

namespace blactl::fleet {

/// For can::Bus::filter(), with this own node ID. Empty: all frames.
[[nodiscard]] std::vector<can::Filter> filters(Session::Hearing hearing, dronecan::NodeId local);

} // namespace blactl::fleet
