#pragma once
// The last look at servos whose change is in RAM only.

#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Why a servo does not hold in RAM any more what was proven while others were still at work: of
/// each its error, state (it has restarted, or cannot prove that it has not; another servo is in
/// its place), timeout or duplicate_node_id; empty: it has run on. Errors: as Session::run().
[[nodiscard]] Result<std::vector<std::optional<Error>>>
look_last(Session& session, std::span<const Servo> servos, Patience patience);

} // namespace blactl::fleet
