#pragma once
// Goals that give units on the bus static node IDs, and nothing else.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/fleet/change/goal.hpp"
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

/// The unit that is meant: of this bus, waiting for a node ID or not, or by its whole unique ID.
/// Errors: not_found; usage (several are meant); duplicate_node_id.
[[nodiscard]] Result<dronecan::UniqueId> unit_meant(const WantedId& wanted, const Roster& roster,
                                                    const bla::Profiles& profiles);

struct Wishes {
  std::vector<state::AllocationStore::Wish> wishes{};
  std::vector<Error>
      errors{}; ///< of those that mean nobody: as unit_meant(); usage: one is named twice
};

/// The units that are meant.
[[nodiscard]] Wishes wishes_of(std::span<const WantedId> wanted, const Roster& roster,
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

/// The goals that give units their wanted IDs.
struct StaticGoals {
  std::vector<Goal> goals{};   ///< by wanted ID
  std::vector<Error> errors{}; ///< for missing units
};

/// `not_let_in`: from let_in(). The roster knows the static node IDs.
[[nodiscard]] StaticGoals static_goals(const Roster& roster, const bla::Profiles& profiles,
                                       std::vector<state::AllocationStore::Wish> wishes,
                                       const NotLetIn& not_let_in);

/// Whether nobody else on the bus has this ID. Errors: duplicate_node_id.
[[nodiscard]] Result<void> may_have(const Roster& roster, const dronecan::UniqueId& unit,
                                    dronecan::NodeId id);

/// Enters what a person wishes; other units lose these IDs. Returns a sentence for each that does.
/// Errors: as AllocationStore::enter().
[[nodiscard]] Result<std::vector<std::string>>
enter_wishes(state::AllocationStore& table, std::span<const state::AllocationStore::Wish> wishes,
             WallTime now);

/// Whether this unit has a node ID on this bus, or waits for one; also where it cannot be told, as
/// a node that does not say who it is, or one of two, has its ID.
[[nodiscard]] bool may_be_on_bus(const Roster& roster, const state::AllocationEntry& entry);

/// Enters the servos heard in the last seconds: those with a static node ID, and those that the
/// table does not know; of the others it knows better which ID they are to get. Errors: as
/// AllocationStore::enter().
[[nodiscard]] Result<void> enter_seen(state::AllocationStore& table, const Roster& roster, Time now,
                                      WallTime wall);

/// Enters the IDs that units have as wished already; those that are given are entered on the way.
/// Errors: as AllocationStore::enter().
[[nodiscard]] Result<void> enter_kept(state::AllocationStore& table,
                                      std::span<const state::AllocationStore::Wish> kept,
                                      WallTime now);

} // namespace blactl::fleet
