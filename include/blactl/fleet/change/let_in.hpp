#pragma once
// Node IDs for units that wait for one, before a command looks for its servos.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/state/allocation_store.hpp"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Allocates IDs from the table to those of `units` that ask (empty: to all), and waits until none
/// asks any more. New units get none of those `avoided`. Not if another allocator is heard. Returns
/// those that asked. Errors: those that end a session.
[[nodiscard]] Result<std::vector<AllocatedUnit>>
let_in(Session& session, state::AllocationStore& table,
       std::optional<std::vector<dronecan::UniqueId>> units, const state::NodeIds& avoided = {});

/// The reasons why units have no node ID though they asked for one.
using NotLetIn = std::map<dronecan::UniqueId, Error>;

struct LetIn {
  NotLetIn left{};                        ///< those still missing that have asked
  std::vector<AllocatedUnit> allocated{}; ///< those that had no ID in the table
};

/// Allocates only to missing units with a wish: each gets its wanted ID for the time being. Waits
/// until they are there; the caller judges those still missing. Errors: those that end a session,
/// and those of the table.
[[nodiscard]] Result<LetIn> let_in(Session& session, state::AllocationStore& table,
                                   std::span<const state::AllocationStore::Wish> wishes);

} // namespace blactl::fleet
