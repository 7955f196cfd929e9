#pragma once
// Which node IDs servos are to get: the wishes of a person, before anything is changed.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/state/allocation_store.hpp"

#include <set>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// A node ID that is wished for one servo.
struct WantedId {
  Targets whom; ///< one node ID, or one selector
  dronecan::NodeId node_id;
  std::string text{}; ///< the servo as typed: "serial:240900558"
};

/// Whether it is a whole unique ID, which no other unit has.
[[nodiscard]] bool names_one_unit(const WantedId& wanted);

/// The unit that is meant: of this bus, waiting for a node ID or not, or by its whole unique ID.
/// Errors: not_found; usage (several are meant, or perhaps one that waits, too); duplicate_node_id.
[[nodiscard]] Result<dronecan::UniqueId> unit_meant(const WantedId& wanted, const Roster& roster,
                                                    const bla::Profiles& profiles);

/// The units that are meant, and why others are not known.
struct UnitsMeant {
  std::vector<state::AllocationStore::Wish> wishes{};
  std::vector<Error> errors{}; ///< as unit_meant(); usage: a unit is named twice
};

[[nodiscard]] UnitsMeant units_meant(std::span<const WantedId> wanted, const Roster& roster,
                                     const bla::Profiles& profiles);

/// IDs of the range from `first` to `last`: those who have one keep it, the others get the lowest
/// that nobody on the bus has, in the order of their serial numbers. `newcomers` have theirs for
/// the time being only. Errors: table_full: there are fewer; timeout: a serial number is not known;
/// as ids_as_they_are().
[[nodiscard]] Result<std::vector<state::AllocationStore::Wish>>
ids_within(const AllocationService::Range& range, const Roster& roster,
           std::span<const dronecan::NodeId> nodes, const std::set<dronecan::UniqueId>& newcomers);

/// The present ID of each of these nodes, as a wish. Errors: duplicate_node_id; timeout (its unique
/// ID is unknown).
[[nodiscard]] Result<std::vector<state::AllocationStore::Wish>>
ids_as_they_are(const Roster& roster, std::span<const dronecan::NodeId> nodes);

/// Whether nobody else on the bus has this ID. Errors: duplicate_node_id.
[[nodiscard]] Result<void> may_have(const Roster& roster, const dronecan::UniqueId& unit,
                                    dronecan::NodeId id);

} // namespace blactl::fleet
