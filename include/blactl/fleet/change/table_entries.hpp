#pragma once
// The entries of the allocation table that no allocation makes: what a person wishes, and what was
// seen on the bus.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/state/allocation_store.hpp"

#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// Enters what a person wishes; other units lose these IDs. Returns a sentence for each that does.
/// Errors: as AllocationStore::enter().
[[nodiscard]] Result<std::vector<std::string>>
enter_wishes(state::AllocationStore& table, std::span<const state::AllocationStore::Wish> wishes,
             WallTime now);

/// Whether this unit has a node ID on this bus, or waits for one; also where it cannot be told, as
/// a node that does not say who it is, or one of two, has its ID.
[[nodiscard]] bool may_be_on_bus(const Roster& roster, const state::AllocationEntry& entry);

/// Enters the servos heard in the last seconds: those with a static node ID, and those that the
/// table does not know; of the others it knows better which ID they are to get. Errors: as
/// AllocationStore::enter().
[[nodiscard]] Result<void> enter_seen(state::AllocationStore& table, const Roster& roster, Time now,
                                      WallTime wall);

/// Enters the IDs that units have as wished already; those that are given are entered on the way.
/// Errors: as AllocationStore::enter().
[[nodiscard]] Result<void> enter_kept(state::AllocationStore& table,
                                      std::span<const state::AllocationStore::Wish> kept,
                                      WallTime now);

} // namespace blactl::fleet
