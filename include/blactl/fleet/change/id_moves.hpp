#pragma once
// The order in which units get static node IDs if some want the present IDs of others: two are
// never on one ID, not even for a moment or after a power cut.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// A unit on the bus and its node IDs. It occupies both: another unit on one of them would collide
/// now, or after a restart.
struct IdHolder {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId id; ///< its present ID, 1 to 127
  /// 0x46 in ROM; 0: its ID is from an allocator. Empty: unknown; then its move is not skipped, and
  /// an ID that only its ROM holds is not reserved.
  std::optional<std::int64_t> static_node_id{};
};

/// A move of one unit to a node ID, mostly a static one: 0x46 is written, saved, the unit
/// restarted, and seen on `to`.
struct IdMove {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId from; ///< its present ID; `to` itself, if only its ROM must follow
  dronecan::NodeId to;
  bool is_temporary = false; ///< it makes way for others, and moves again later
  bool is_dynamic = false;   ///< 0 is saved: the unit asks for an ID, and is to get `to`

  friend bool operator==(const IdMove&, const IdMove&) = default;
};

/// The moves of one round may be carried out at once and in any order, those of the next when all
/// of them are done. After a cut anywhere, or a failed move, a new plan from the state of the bus
/// still reaches the goal.
using IdRounds = std::vector<std::vector<IdMove>>;

/// Plans the fewest moves that give each unit its wanted static node ID: one per unit, none for a
/// unit that already has it, one more for each cycle of units that wait for each other. That one
/// leads to the highest free ID that is not wanted, and if possible not in `promised`.
///
/// `units`: all units on the bus that reported their IDs, each once; those without a wish stay.
/// `wishes`: 1 to 125.
/// `taken`: IDs of further nodes and our own. `promised`: IDs in the allocation table of units that
/// are not on this bus; a wish overrides them. `become_dynamic`: units without a wish whose static
/// ID is given up; they move only where others want it or the present one. Errors, all of them:
/// not_found (no such unit), out_of_range, usage (two wishes for one ID or one unit),
/// duplicate_node_id (its present holder stays); else table_full (a cycle, and no free ID).
[[nodiscard]] std::expected<IdRounds, std::vector<Error>>
plan_id_moves(std::span<const IdHolder> units, std::span<const state::AllocationStore::Wish> wishes,
              const state::NodeIds& taken, const state::NodeIds& promised = {},
              std::span<const dronecan::UniqueId> become_dynamic = {});

} // namespace blactl::fleet
