#pragma once
// Matches the entries of a fleet file with the servos on a bus.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// "serial_number 240900558, model BLA21-12U-AB": the keys of an entry, for people.
[[nodiscard]] std::string text(const Match& match);

struct FleetMatch {
  struct Pair {
    const FleetEntry* entry;
    dronecan::NodeId id;
  };

  struct Misfit {
    const FleetEntry* entry;
    dronecan::NodeId id;
    Error error;
  };

  std::vector<Pair> pairs;                 ///< by node ID
  std::vector<const FleetEntry*> missing;  ///< no servo on the bus matches
  std::vector<const FleetEntry*> left_out; ///< their servos are not selected by -n
  std::vector<dronecan::NodeId> extra;     ///< servos without an entry
  /// Selected servos that a recipe is not for, each with the reason: as check_fit().
  std::vector<Misfit> misfits;
  std::vector<std::string_view> ids_left_out; ///< names: a parameter file is for several servos
  /// usage: an entry that matches several servos though it must match one, a servo matched by two
  /// entries, one matched by a node ID that is not permanently its own; a parameter file with
  /// several servos that nobody selected, or that has only IDs for several; a recipe with an ID for
  /// several. not_found, timeout, duplicate_node_id: selected by -n, but missing or not a single
  /// servo; a parameter file without a servo. timeout: a servo has not said who it is, and an entry
  /// for several servos, or -n, may mean it.
  std::vector<Error> errors;
};

/// The error for an entry that no servo matches, while one has not said who it is: timeout. Empty:
/// each has.
[[nodiscard]] std::optional<Error> may_be_unidentified(const FleetEntry& entry,
                                                       const Roster& roster);

/// `file` outlives the result. The session has searched the bus (Discovery::find_all, with the
/// static node IDs); node IDs shared by two units match no servo. `is_recording`: the bus is one.
[[nodiscard]] FleetMatch match(const FleetFile& file, const Roster& roster, const Targets& targets,
                               const bla::Profiles& profiles, bool is_recording = false);

} // namespace blactl::fleet
