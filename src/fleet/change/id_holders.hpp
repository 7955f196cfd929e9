#pragma once
// The holders of node IDs on a bus, from which moves are planned (id_moves.hpp).

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/id_moves.hpp"
#include "blactl/state/allocation_store.hpp"

#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Whether this unit is heard under some node ID.
[[nodiscard]] bool is_here(const Roster& roster, const dronecan::UniqueId& unit);

/// All nodes with a known unique ID, each once. A unit occupies its ID, and the one in its 0x46;
/// one with a wish gives the latter up: the contents of its ROM are unknown, so its move is not
/// skipped.
[[nodiscard]] std::vector<IdHolder> holders(const Roster& roster,
                                            std::span<const state::AllocationStore::Wish> wishes);

/// The present node ID of a unit that has it from its own 0x46: it does not ask for one, whatever
/// the table promises. Empty: it is not here, or has another ID.
[[nodiscard]] std::optional<dronecan::NodeId> static_place(const Roster& roster,
                                                           const dronecan::UniqueId& unique_id);

/// The node IDs that plans must not use, and those to avoid.
struct TakenIds {
  state::NodeIds taken;    ///< of unidentified nodes and waiting units, and our own
  state::NodeIds promised; ///< of units in the table that are not on this bus
  std::vector<state::AllocationEntry> absent{}; ///< those units
};

/// The holders of IDs other than the units of `wishes`. Errors: of the table.
[[nodiscard]] Result<TakenIds> taken_ids(const Roster& roster, const state::AllocationStore& table,
                                         std::span<const state::AllocationStore::Wish> wishes);

} // namespace blactl::fleet
