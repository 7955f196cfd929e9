#pragma once
// Who has which node ID on a bus: what a plan of moves (id_moves.hpp) starts from.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/id_moves.hpp"
#include "blactl/state/allocation_store.hpp"

#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// This unit is heard under some node ID.
[[nodiscard]] bool is_here(const Roster& roster, const dronecan::UniqueId& unit);

/// Everybody who told its unique ID, each once. A unit holds its ID, and what it would get by its
/// 0x46; one for which another is wished gives that up: what its ROM holds nobody knows, so its
/// move is not spared.
[[nodiscard]] std::vector<IdHolder> holders(const Roster& roster,
                                            std::span<const state::AllocationStore::Wish> wishes);

/// Where this unit is that has its node ID by its own 0x46: it asks for none, whatever the table
/// promises. Empty: it is not here, or not so.
[[nodiscard]] std::optional<dronecan::NodeId> static_place(const Roster& roster,
                                                           const dronecan::UniqueId& unique_id);

/// The node IDs that no plan may take, and those that it may.
struct TakenIds {
  state::NodeIds taken;    ///< of nodes that did not say who they are, waiting units, and our own
  state::NodeIds promised; ///< of units in the table that are not on this bus
  std::vector<state::AllocationEntry> absent{}; ///< those units
};

/// Whose the IDs are for which no unit of `wishes` is the holder. Errors: of the table.
[[nodiscard]] Result<TakenIds> taken_ids(const Roster& roster, const state::AllocationStore& table,
                                         std::span<const state::AllocationStore::Wish> wishes);

} // namespace blactl::fleet
