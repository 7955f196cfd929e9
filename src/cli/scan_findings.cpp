#include "cli/scan_findings.hpp"

#include "blactl/fleet/texts.hpp"

#include "cli/output/health_words.hpp"
#include "cli/output/node_head.hpp"
#include "cli/texts.hpp"

#include <functional>
#include <map>
#include <utility>

namespace blactl::cli {

using dronecan::NodeId;
using fleet::Member;
using fleet::Roster;

namespace {

std::string join(const std::vector<NodeId>& nodes) {
  std::string out;
  for (const NodeId id : nodes) {
    out += out.empty() ? "" : ", ";
    out += std::to_string(id.value());
  }
  return out;
}

/// Servos that share the number that `key` gives.
template <const Text& text>
void find_shared(const Roster& roster, Code code,
                 const std::function<std::optional<std::int64_t>(const Member&)>& key,
                 std::vector<Conflict>& conflicts) {
  std::map<std::int64_t, std::vector<NodeId>> holders;
  for (const auto& [id, member] : roster.members()) {
    if (const auto number = member.is_servo ? key(member) : std::nullopt) {
      holders[*number].push_back(id);
    }
  }
  for (auto& [number, nodes] : holders) {
    if (nodes.size() > 1) {
      std::string said = say<text>(join(nodes), number);
      conflicts.push_back({code, std::move(nodes), std::move(said)});
    }
  }
}

std::vector<Conflict> find_conflicts(const Roster& roster) {
  std::vector<Conflict> conflicts;
  for (const NodeId id : roster.doubled()) {
    conflicts.push_back({Code::duplicate_node_id, {id}, say<texts::doubled_node_id>(id.value())});
  }
  const auto static_id = [](const Member& member) {
    return member.static_node_id.value_or(0) != 0 ? member.static_node_id : std::nullopt;
  };
  find_shared<texts::doubled_static_id>(roster, Code::duplicate_node_id, static_id, conflicts);
  find_shared<texts::doubled_servo_id>(
      roster, Code::duplicate_servo_id, [](const Member& member) { return member.servo_id; },
      conflicts);
  return conflicts;
}

} // namespace

/// The newest status: heard by itself, else the one of GetNodeInfo.
std::optional<dronecan::NodeStatus> status(const Member& member) {
  if (member.status) {
    return member.status;
  }
  return member.info ? std::optional(member.info->status) : std::nullopt;
}

std::vector<std::string> warnings(const Member& member) {
  std::vector<std::string> out;
  if (const auto now = status(member); now && now->health != dronecan::Health::ok) {
    out.push_back(say<texts::warn_health>(name(now->health)));
  }
  if (!member.is_servo) {
    return out;
  }
  const bla::Identity& identity = member.identity;
  const auto& readings = identity.readings();
  constexpr std::int64_t stall_mended = 1400; // chapter 5
  const std::string model = identity.model();
  if (model.empty()) {
    out.push_back(say<texts::warn_unknown_model>());
  } else if (!identity.certain() && readings.hardware_version) {
    out.push_back(say<texts::warn_uncertain_model>(*readings.hardware_version));
  }
  if (readings.firmware_version && *readings.firmware_version < stall_mended &&
      (model.starts_with("BLA15") || model.starts_with("BLA21"))) {
    out.push_back(say<texts::warn_stall>(version_text(*readings.firmware_version)));
  }
  if (member.static_node_id.value_or(0) != 0 && *member.static_node_id != member.id.value()) {
    out.push_back(say<texts::warn_static_id_differs>(*member.static_node_id));
  }
  return out;
}

Findings gather(const Roster& roster, const fleet::Targets& targets,
                const bla::Profiles& profiles) {
  Findings findings{&roster, {}, {}};
  for (const auto& [id, member] : roster.members()) {
    if (roster.heard(id) && (!targets.given || targets.mean(member, profiles))) {
      findings.nodes.push_back(&member);
    }
  }
  findings.conflicts = find_conflicts(roster);
  return findings;
}

} // namespace blactl::cli
