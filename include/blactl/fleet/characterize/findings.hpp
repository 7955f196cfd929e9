#pragma once
// Findings about the nodes on a bus, for technicians.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/target.hpp"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// Nodes that must not be on one bus together as configured.
struct Conflict {
  Code code; ///< duplicate_node_id, duplicate_unique_id, duplicate_servo_id
  std::vector<dronecan::NodeId> nodes;
  std::string text, hint;
};

/// One unit on the bus. If two units share a node ID, each has a finding with only what is certain
/// to be its own.
struct Finding {
  Servo servo;
  std::optional<dronecan::GetNodeInfo::Response> info{};
  std::optional<dronecan::NodeStatus> status{}; ///< the newest
  bool is_foreign = false; ///< it has identified itself as another device than a BLA servo
  bool is_offline = false; ///< heard earlier but silent now, or it does not respond
  std::vector<std::string> warnings{};
};

struct Findings {
  const Roster* roster;
  std::vector<Finding> nodes; ///< those selected by -n; all without it
  std::vector<Conflict> conflicts;
};

/// The time up to which the bus was heard: now, or the last frame of a recording.
[[nodiscard]] Time heard_until(const Session& session);

/// The findings at `now`. `roster` outlives the findings. `gone`: nodes that did not respond to
/// their last request.
[[nodiscard]] Findings gather(const Roster& roster, const Targets& targets,
                              const bla::Profiles& profiles, Time now,
                              const std::set<dronecan::NodeId>& gone = {});

/// Lines about other active nodes on this bus: they allocate, command, or report armed.
[[nodiscard]] std::vector<std::string> others(const Roster& roster);

/// Notes of writing commands that forbid nothing: the other nodes, and servos that share a servo ID
/// other than 0 (the ID of all fresh servos).
[[nodiscard]] std::vector<std::string> notes_before_writing(const Roster& roster);

/// The nodes that command servos.
[[nodiscard]] std::vector<dronecan::NodeId> commanders(const Roster& roster);

/// Whether it has a node ID for tools, and is not a servo: such nodes come and go.
[[nodiscard]] bool is_tool(const Finding& node);

/// Warnings about one node.
[[nodiscard]] std::vector<std::string> warnings(const Member& member);

/// The newest status: from NodeStatus, else from GetNodeInfo.
[[nodiscard]] std::optional<dronecan::NodeStatus> status(const Member& member);

} // namespace blactl::fleet
