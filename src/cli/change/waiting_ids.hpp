#pragma once
// What a dry run tells of units that wait for a node ID.

#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/bus/roster.hpp"

#include <string>
#include <string_view>

namespace blactl::cli {

/// The node ID that a waiting unit would get, in words: that of the allocation table behind
/// `interface`, if nobody has it, else a free one.
[[nodiscard]] std::string would_get_id(const dronecan::UniqueId& unit, const fleet::Roster& roster,
                                       std::string_view interface);

} // namespace blactl::cli
