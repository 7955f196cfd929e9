#pragma once
// What the others on the bus forbid (contract, section 4).

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <optional>

namespace blactl::fleet {

/// Why this plan must not be carried out now, as far as the bus was heard; empty: it may.
/// Errors: duplicate_node_id, state (the servo restarted since it was read), armed, driven unless
/// `while_driven`, if the plan moves the servo; out_of_range for a static node ID that
/// is ours; what others have is for survey() to find.
[[nodiscard]] std::optional<Error> forbidden(const Roster& roster, Time now, const Plan& plan,
                                             bool while_driven);

} // namespace blactl::fleet
