#pragma once
// What the others on the bus forbid (contract, section 4).

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <optional>
#include <string>
#include <vector>

namespace blactl::fleet {

struct Plan;

/// Decides whether anything may be sent that changes a servo, as far as the bus was heard. Nobody
/// else does: it is asked before each write, opcode, restart and ArrayCommand, however long a
/// command runs.
class Guard {
 public:
  /// `roster` outlives this. `may_be_driven`: also while another node drives the servo.
  Guard(const Roster& roster, bool may_be_driven)
      : roster_(&roster), may_be_driven_(may_be_driven) {}

  /// Why nothing may be sent to this servo now; empty: it may. Errors: duplicate_node_id, armed,
  /// driven.
  [[nodiscard]] std::optional<Error> forbids(const Servo& servo, Time now) const;

  /// The same request, which leaves only while nothing forbids it, and is withheld otherwise.
  /// `servo` outlives the request.
  [[nodiscard]] dronecan::Request guarded(dronecan::Request request, const Servo& servo) const;

 private:
  const Roster* roster_;
  bool may_be_driven_;
};

/// Why this plan must not be carried out now, as far as the bus was heard; empty: it may.
/// Errors: as Guard::forbids(), driven only if the plan moves the servo and not `while_driven`;
/// state (the servo restarted since it was read); out_of_range for a static node ID that is ours;
/// what others have is for survey() to find.
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
