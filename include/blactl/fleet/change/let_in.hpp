#pragma once
// Units that wait for a node ID get one, so that they can be asked who they are.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/state/allocation_store.hpp"

namespace blactl::fleet {

/// Serves all that ask, and lives until they are there under their IDs, or have had the time for
/// it. The session has searched the bus. Errors: those that end a session, and those of the table.
[[nodiscard]] Result<void> let_in(Session& session, state::AllocationStore& table);

} // namespace blactl::fleet
