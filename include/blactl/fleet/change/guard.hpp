#pragma once
// Refusals because of other nodes on the bus (contract, section 4).

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

struct Plan;

/// The only judge of whether a request that changes a servo may be sent, as far as the bus was
/// heard. It is asked before each write, opcode, restart and ArrayCommand, however long a command
/// runs.
class Guard {
 public:
  /// `roster` outlives this. `may_be_driven`: also while another node drives the servo.
  Guard(const Roster& roster, bool may_be_driven) : Guard(roster, may_be_driven, may_be_driven) {}

  /// `may_become_driven`: also where it gets a servo ID that another node commands.
  Guard(const Roster& roster, bool may_be_driven, bool may_become_driven)
      : roster_(&roster), may_be_driven_(may_be_driven), may_become_driven_(may_become_driven) {}

  /// The reason why nothing may be sent to this servo now; empty: it may. `next_servo_id`: the one
  /// that the servo obeys afterwards; empty: the present one, as far as known. Errors:
  /// duplicate_node_id, duplicate_unique_id, armed, driven.
  [[nodiscard]] std::optional<Error>
  forbids(const Servo& servo, Time now,
          std::optional<std::int64_t> next_servo_id = std::nullopt) const;

  /// The same request, which leaves only while nothing forbids it, and is withheld otherwise.
  /// `servo` outlives the request.
  [[nodiscard]] dronecan::Request
  guarded(dronecan::Request request, const Servo& servo,
          std::optional<std::int64_t> next_servo_id = std::nullopt) const;

 private:
  const Roster* roster_;
  bool may_be_driven_, may_become_driven_;
};

/// The reason why this plan must not be carried out now, as far as the bus was heard; empty: it
/// may. Errors: as Guard::forbids(), driven only if the plan moves the servo and not
/// `while_driven`; state (the servo restarted since it was read); out_of_range for a static node ID
/// that is ours; IDs of others are checked by survey().
[[nodiscard]] std::optional<Error> forbidden(const Roster& roster, Time now, const Plan& plan,
                                             bool while_driven);

/// The findings about other nodes before anything is written.
struct OthersHeard {
  std::vector<std::string> notes{}; ///< notes for the user
  std::vector<Error> errors{};      ///< why nothing may be written
};

/// Waits until the bus was heard long enough to know the active nodes, and asks servos that were
/// not asked yet for their unique ID, with `patience`. `searched`: the time of the last frame heard
/// in the search for the servos; one that came since may be among the selected ones, unless it is
/// one of `own`, which this command has restarted. Errors: state (such a servo, or lost frames);
/// one that ends a session is the only one.
[[nodiscard]] OthersHeard hear_others(Session& session, Patience patience,
                                      std::optional<Time> searched,
                                      std::span<const dronecan::UniqueId> own = {});

} // namespace blactl::fleet
