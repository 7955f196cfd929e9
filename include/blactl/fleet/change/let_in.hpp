#pragma once
// Node IDs for units that wait for one, before servos are changed.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/state/allocation_store.hpp"

#include <map>
#include <span>

namespace blactl::fleet {

/// Gives units that ask for a node ID one from the table, and lives until nobody asks any more. Not
/// where another allocator is heard. Errors: those that end a session.
[[nodiscard]] Result<void> let_in(Session& session, state::AllocationStore& table);

/// Why units have no node ID though they asked for one.
using NotLetIn = std::map<dronecan::UniqueId, Error>;

/// The same for those alone for which an ID is wished and that are not there: each gets its own for
/// the time being. Lives until they are there; who is still away then is for others to judge.
/// Errors: those that end a session, and those of the table.
[[nodiscard]] Result<NotLetIn> let_in(Session& session, state::AllocationStore& table,
                                      std::span<const state::AllocationStore::Wish> wishes);

} // namespace blactl::fleet
