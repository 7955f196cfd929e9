#pragma once
// What the others on the bus forbid (contract, section 4).

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace blactl::fleet {

/// Why this plan must not be carried out now, as far as the bus was heard; empty: it may.
/// Errors: duplicate_node_id, state (the servo restarted since it was read), armed, driven unless
/// `while_driven`, if the plan moves the servo; out_of_range for a static node ID that
/// is ours; what others have is for survey() to find.
[[nodiscard]] std::optional<Error> forbidden(const Roster& roster, Time now, const Plan& plan,
                                             bool while_driven);

/// What was heard of the others before anything is written.
struct OthersHeard {
  std::vector<std::string> notes{}; ///< what a person should know of them
  std::vector<Error> errors{};      ///< why nothing may be written
};

/// Lives until the bus was heard long enough to know who acts on it. `searched`: when servos were
/// chosen by a search; one that came since may be one of those that are meant. Errors: state (that,
/// or frames were lost); what ends a session stands alone.
[[nodiscard]] OthersHeard hear_others(Session& session, std::optional<Time> searched);

} // namespace blactl::fleet
