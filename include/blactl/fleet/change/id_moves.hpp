#pragma once
// In which order units get static node IDs, where some wish what others still have: never two on
// one ID, not for a moment, and not after a power cut either.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// A unit on the bus and its node IDs. It holds both: who takes one of them would meet it now, or
/// after a restart.
struct IdHolder {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId id; ///< under which it is heard, 1 to 127
  /// 0x46 in ROM; 0: an allocator gave it its ID. Empty: not known; then its move is not spared,
  /// and an ID that only its ROM holds is not kept from others.
  std::optional<std::int64_t> static_node_id{};
};

/// One unit is given a static node ID: 0x46 is written, saved, the unit restarted, and seen on
/// `to`.
struct IdMove {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId from; ///< where it is heard; `to` itself, where only its ROM must follow
  dronecan::NodeId to;
  bool is_temporary = false; ///< it makes way for others, and moves once more later

  friend bool operator==(const IdMove&, const IdMove&) = default;
};

/// The moves of one round may be carried out at once and in any order, those of the next when all
/// of them are done. After a cut anywhere, or a move that failed, a new plan from what the bus then
/// tells ends as wished.
using IdRounds = std::vector<std::vector<IdMove>>;

/// The least moves that give each unit the static node ID that is wished for it: one a unit, none
/// for a unit that has it already, one more for each cycle of units that wait for each other. That
/// one leads to the highest free ID, which nobody wishes, and none of `promised` if it can.
///
/// `units`: all that are on the bus and tell their IDs, each once; who is not wished for stays.
/// `wishes`: 1 to 125; 0, dynamic, is none: which ID an allocator will give, no plan can know.
/// `taken`: what others have: further nodes, we ourselves.
/// `promised`: what the allocation table keeps for units that are not on this bus. A wish is
/// stronger.
/// Errors, all of them: not_found (no such unit), out_of_range, usage (two wishes for one ID or one
/// unit), duplicate_node_id (who has it stays); else table_full (a cycle, and no free ID).
[[nodiscard]] std::expected<IdRounds, std::vector<Error>>
plan_id_moves(std::span<const IdHolder> units, std::span<const state::AllocationStore::Wish> wishes,
              const state::NodeIds& taken, const state::NodeIds& promised = {});

} // namespace blactl::fleet
