#pragma once
// What a scan found, and how it is shown.

#include "blactl/base/error.hpp"
#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/roster.hpp"
#include "blactl/fleet/target.hpp"

#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// Nodes that must not be as they are, together on one bus.
struct Conflict {
  Code code; ///< duplicate_node_id, duplicate_servo_id
  std::vector<dronecan::NodeId> nodes;
  std::string text;
};

struct Findings {
  const fleet::Roster* roster;
  std::vector<const fleet::Member*> nodes; ///< those that -n names; all without it
  std::vector<Conflict> conflicts;
};

/// `roster` outlives the findings.
[[nodiscard]] Findings gather(const fleet::Roster& roster, const fleet::Targets& targets,
                              const bla::Profiles& profiles);

/// What a technician should know of one node.
[[nodiscard]] std::vector<std::string> warnings(const fleet::Member& member);

/// The newest status: heard by itself, else that of GetNodeInfo.
[[nodiscard]] std::optional<dronecan::NodeStatus> status(const fleet::Member& member);

// The three views.
void write_json(JsonWriter& json, const Findings& findings);
[[nodiscard]] std::string csv(const Findings& findings);
[[nodiscard]] std::string text(const Findings& findings);

} // namespace blactl::cli
