#pragma once
// What a technician should know of the nodes on a bus.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/target.hpp"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// Nodes that must not be as they are, together on one bus.
struct Conflict {
  Code code; ///< duplicate_node_id, duplicate_servo_id
  std::vector<dronecan::NodeId> nodes;
  std::string text, hint;
};

/// One unit on the bus. Of each of two units on one node ID this says who it is, as far as it said
/// so itself, and nothing that may be of the other.
struct Finding {
  Servo servo;
  std::optional<dronecan::GetNodeInfo::Response> info{};
  std::optional<dronecan::NodeStatus> status{}; ///< the newest
  bool is_foreign = false;                      ///< it said that it is no BLA servo
  bool is_offline = false; ///< it was heard, and is not any more, or does not answer either
  std::vector<std::string> warnings{};
};

struct Findings {
  const Roster* roster;
  std::vector<Finding> nodes; ///< those that -n names; all without it
  std::vector<Conflict> conflicts;
};

/// Until when the bus was heard: now, or the last frame of a recording.
[[nodiscard]] Time heard_until(const Session& session);

/// What is there at `now`. `roster` outlives the findings. `gone`: those who did not answer when
/// they were asked last.
[[nodiscard]] Findings gather(const Roster& roster, const Targets& targets,
                              const bla::Profiles& profiles, Time now,
                              const std::set<dronecan::NodeId>& gone = {});

/// Who else acts on this bus: allocates, commands, says armed.
[[nodiscard]] std::vector<std::string> others(const Roster& roster);

/// What a command that writes tells of, where it forbids nothing: the others, and servos that obey
/// one servo ID other than 0 (fresh servos all have that).
[[nodiscard]] std::vector<std::string> notes_before_writing(const Roster& roster);

/// The nodes that move servos.
[[nodiscard]] std::vector<dronecan::NodeId> commanders(const Roster& roster);

/// It has an ID of tools, and is no servo: it comes and goes as people work.
[[nodiscard]] bool is_tool(const Finding& node);

/// What a technician should know of one node.
[[nodiscard]] std::vector<std::string> warnings(const Member& member);

/// The newest status: heard by itself, else that of GetNodeInfo.
[[nodiscard]] std::optional<dronecan::NodeStatus> status(const Member& member);

} // namespace blactl::fleet
