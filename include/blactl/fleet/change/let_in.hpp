#pragma once
// Allocates node IDs to waiting units, before servos are changed.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/state/allocation_store.hpp"

#include <map>
#include <span>

namespace blactl::fleet {

/// Allocates IDs from the table to units that ask, and waits until none asks any more. Not if
/// another allocator is heard. Errors: those that end a session.
[[nodiscard]] Result<void> let_in(Session& session, state::AllocationStore& table);

/// The reasons why units have no node ID though they asked for one.
using NotLetIn = std::map<dronecan::UniqueId, Error>;

/// Allocates only to missing units with a wish: each gets its wanted ID for the time being. Waits
/// until they are there; the caller judges those still missing. Errors: those that end a session,
/// and those of the table.
[[nodiscard]] Result<NotLetIn> let_in(Session& session, state::AllocationStore& table,
                                      std::span<const state::AllocationStore::Wish> wishes);

} // namespace blactl::fleet
