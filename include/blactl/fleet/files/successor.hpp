#pragma once
// A servo that takes the place of a broken one: who it is, and what it gets (contract, section 7,
// `replace`).

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// The servo for the place of `entry`, one of those of `file`.
struct Successor {
  dronecan::NodeId id;
  /// The entry means it already: it was given the place before, or it is the broken one itself.
  bool is_meant = false;
};

/// Without -n the only one that no entry means; with it the one `selected`. The session has
/// searched the bus. Errors: not_found (none); several_servos (more than one, or the one that the
/// entry means is there beside it); model_mismatch; timeout (one has not said who it is); usage (an
/// entry that is for all servos of a model, a servo of another entry); as match().
[[nodiscard]] Result<Successor> find_successor(const FleetFile& file, const FleetEntry& entry,
                                               const Roster& roster, const Targets& targets,
                                               std::span<const dronecan::NodeId> selected,
                                               const bla::Profiles& profiles);

/// The servo that this entry means is on the bus, under this node ID, or with 0 waits for one:
/// several_servos.
[[nodiscard]] Error still_there(const FleetFile& file, const FleetEntry& entry,
                                dronecan::NodeId id);

/// Once `unit` has the place: the servo that this entry means, if it has come back, on whatever
/// node ID, or asks for one. Where the entry has no unique ID, any that asks may be it. The session
/// has searched the bus again. Empty: it is not there. Errors: several_servos.
[[nodiscard]] std::optional<Error> come_back(const FleetFile& file, const FleetEntry& entry,
                                             const dronecan::UniqueId& unit, const Roster& roster,
                                             const bla::Profiles& profiles);

/// The old servo of this entry responds on the node ID of its `successor`, whose serial number is
/// `serial`: as far as a unique ID in the entry, or else that node ID, tells. The session has
/// searched the bus. Empty: nobody does. Errors: duplicate_node_id.
[[nodiscard]] std::optional<Error> back_on_its_id(const FleetEntry& entry,
                                                  const dronecan::UniqueId& successor,
                                                  std::optional<std::int64_t> serial,
                                                  const Roster& roster);

/// Whether the entry tells that it is of this unit, and not of any that has its other keys.
[[nodiscard]] bool names_unit(const FleetEntry& entry, const Servo& unit);

/// What the successor gets: all of the entry, and the IDs by which it finds its servo. Errors: none
/// of a valid entry.
[[nodiscard]] Result<std::vector<bla::Assignment>>
settings_of_successor(const FleetEntry& entry, const bla::Profiles& profiles);

} // namespace blactl::fleet
