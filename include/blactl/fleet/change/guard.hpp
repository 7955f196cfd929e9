#pragma once
// Refusals because of other nodes on the bus (contract, section 4).

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The reason why this plan must not be carried out now, as far as the bus was heard; empty: it
/// may. Errors: duplicate_node_id, state (the servo restarted since it was read), armed, driven
/// unless `while_driven`, if the plan moves the servo; out_of_range for a static node ID that is
/// ours; IDs of others are checked by survey().
[[nodiscard]] std::optional<Error> forbidden(const Roster& roster, Time now, const Plan& plan,
                                             bool while_driven);

/// The findings about other nodes before anything is written.
struct OthersHeard {
  std::vector<std::string> notes{}; ///< notes for the user
  std::vector<Error> errors{};      ///< why nothing may be written
};

/// Waits until the bus was heard long enough to know the active nodes. `searched`: the time of the
/// search for the servos; one that came since may be among the selected ones. Errors: state (such a
/// servo, or lost frames); one that ends a session is the only one.
[[nodiscard]] OthersHeard hear_others(Session& session, std::optional<Time> searched);

} // namespace blactl::fleet
