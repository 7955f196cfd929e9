#pragma once
// Units that ask for a node ID and have the unique ID of a servo that is going to restart.

#include "blactl/fleet/bus/session.hpp"

#include <span>
#include <vector>

namespace blactl::fleet {

/// Such a unit would get the node ID of the servo when both ask. A request begins with six bytes of
/// the unique ID only: where these are those of one of `nodes`, the rest is asked for, without
/// giving an ID. Errors, one for each such node: duplicate_unique_id; one that ends a session is
/// the only one.
[[nodiscard]] std::vector<Error> asking_copies(Session& session,
                                               std::span<const dronecan::NodeId> nodes);

} // namespace blactl::fleet
