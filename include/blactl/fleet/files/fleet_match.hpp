#pragma once
// Which servos on a bus the entries of a fleet file mean.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <string>
#include <vector>

namespace blactl::fleet {

/// "serial_number 240900558, model BLA21-12U-AB": whom an entry means, for people.
[[nodiscard]] std::string text(const Match& match);

struct FleetMatch {
  struct Pair {
    const FleetEntry* entry;
    dronecan::NodeId id;
  };

  std::vector<Pair> pairs;                 ///< by node ID
  std::vector<const FleetEntry*> missing;  ///< no servo on the bus is meant
  std::vector<const FleetEntry*> left_out; ///< their servos are not among those that -n names
  std::vector<dronecan::NodeId> extra;     ///< servos that no entry means
  /// usage: an entry that means several servos though it must mean one, a servo that two entries
  /// mean, one that is found by a node ID which is not its own for good, a parameter file where
  /// there are several servos. not_found, timeout, duplicate_node_id: what -n names, and is not
  /// there, or not one servo; a parameter file, and there is none.
  std::vector<Error> errors;
};

/// `file` outlives the result. The session has searched the bus (Discovery::find_all, with the
/// static node IDs); node IDs that two units share mean no servo.
[[nodiscard]] FleetMatch match(const FleetFile& file, const Roster& roster, const Targets& targets,
                               const bla::Profiles& profiles);

} // namespace blactl::fleet
