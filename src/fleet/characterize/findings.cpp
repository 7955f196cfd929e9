#include "blactl/fleet/characterize/findings.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/defect.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/status_words.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/state/local_node_id.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <map>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// All sharers but one need another ID; an actuator of another make keeps its own.
std::string servo_id_hint(const Roster& roster, const std::vector<NodeId>& sharers) {
  std::vector<NodeId> others;
  std::ranges::copy_if(sharers, std::back_inserter(others),
                       [&](NodeId id) { return !roster.member(id).is_foreign(); });
  if (others.size() == sharers.size()) {
    others.erase(others.begin());
  }
  const std::uint8_t first = others.front().value();
  return others.size() == 1 ? say<texts::doubled_servo_id_hint>(first)
                            : say<texts::shared_servo_id_hint>(id_list(others), first);
}

/// Finds nodes that share the value of `key`; not those of other makes alone.
template <const Text& text>
void find_shared(const Roster& roster, Code code,
                 const std::function<std::optional<std::int64_t>(const Member&)>& key,
                 std::vector<Conflict>& conflicts) {
  std::map<std::int64_t, std::vector<NodeId>> holders;
  for (const auto& [id, member] : roster.members()) {
    const bool is_one = (member.is_servo || member.is_foreign()) && !roster.is_doubled(id) &&
                        !roster.has_moved(member);
    if (const auto number = is_one ? key(member) : std::nullopt) {
      holders[*number].push_back(id);
    }
  }
  for (auto& [number, nodes] : holders) {
    const bool has_servo =
        std::ranges::any_of(nodes, [&](NodeId id) { return roster.member(id).is_servo; });
    if (nodes.size() > 1 && has_servo) {
      std::string said = say<text>(id_list(nodes), number);
      std::string hint = code == Code::duplicate_servo_id ? servo_id_hint(roster, nodes)
                                                          : say<texts::doubled_target_hint>();
      conflicts.push_back({code, std::move(nodes), std::move(said), std::move(hint)});
    }
  }
}

std::vector<Conflict> find_conflicts(const Roster& roster) {
  std::vector<Conflict> conflicts;
  for (const NodeId id : roster.doubled()) {
    Error error = doubled(roster, id);
    conflicts.push_back({error.code, {id}, std::move(error.message), std::move(error.hint)});
  }
  for (const auto& [id, member] : roster.members()) {
    auto nodes = roster.copies(id);
    if (auto error = not_unique(roster, id); !nodes.empty() && id < nodes.front()) {
      nodes.insert(nodes.begin(), id);
      conflicts.push_back(
          {error->code, std::move(nodes), std::move(error->message), std::move(error->hint)});
    }
  }
  const auto static_id = [](const Member& member) {
    return member.static_node_id.value_or(0) != 0 ? member.static_node_id : std::nullopt;
  };
  find_shared<texts::doubled_static_id>(roster, Code::duplicate_node_id, static_id, conflicts);
  find_shared<texts::doubled_servo_id>(roster, Code::duplicate_servo_id, &Member::commanded_id,
                                       conflicts);
  return conflicts;
}

/// Servos send actuator.Status ten times a second: silence of this length means that one is away.
constexpr Duration servo_silence = std::chrono::milliseconds(300);

Finding finding(const Member& member, Time now, bool is_gone) {
  Finding found{.servo = member.servo(),
                .info = member.info,
                .status = status(member),
                .is_foreign = member.is_foreign(),
                .warnings = warnings(member)};
  if (member.info && member.info_boot != member.boots) { // another unit may have come
    found = {.servo = {.id = member.id, .is_servo = member.is_servo},
             .status = found.status,
             .warnings = {say<texts::warn_not_asked>()}};
  }
  const Duration silence = now - member.last_heard;
  found.is_offline = silence >= offline_time || (is_gone && silence >= servo_silence);
  if (silence >= offline_time) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(silence);
    found.warnings.push_back(say<texts::warn_offline>(seconds.count()));
  } else if (is_gone) {
    found.warnings.push_back(found.is_offline ? say<texts::warn_gone>()
                                              : say<texts::warn_unanswered>());
  }
  if (found.is_offline && found.status) {
    found.status->mode = dronecan::Mode::offline;
  }
  return found;
}

/// The units on a shared ID.
std::vector<Finding> units_on(const Roster& roster, const Member& member) {
  const Servo unknown{.id = member.id,
                      .is_servo = member.is_servo || member.sends_actuator_status()};
  std::vector<Finding> units;
  for (const dronecan::UniqueId& unique_id : roster.units(member.id)) {
    units.push_back({.servo = unknown});
    units.back().servo.unique_id = unique_id;
  }
  return units.empty() ? std::vector<Finding>(2, {.servo = unknown}) : units;
}

} // namespace

std::optional<dronecan::NodeStatus> status(const Member& member) {
  if (member.status) {
    return member.status;
  }
  return member.info ? std::optional(member.info->status) : std::nullopt;
}

std::vector<std::string> warnings(const Member& member) {
  std::vector<std::string> out;
  if (const auto now = status(member); now && now->health != dronecan::Health::ok) {
    out.push_back(say<texts::warn_health>(health_word(now->health)));
  }
  if (!member.is_servo) {
    return out;
  }
  if (const auto unique_id = member.unique_id(); unique_id && dronecan::is_blank(*unique_id)) {
    out.push_back(say<texts::blank_unique_id>(member.id.value(), hex(*unique_id)));
  }
  const bla::Identity& identity = member.identity;
  const auto& readings = identity.readings();
  const std::string model = identity.model();
  if (model.empty()) {
    out.push_back(say<texts::warn_unknown_model>());
  } else if (!identity.certain() && readings.hardware_version) {
    out.push_back(say<texts::warn_uncertain_model>(*readings.hardware_version));
  }
  if (bla::may_stall(identity)) {
    out.push_back(say<texts::warn_stall>(bla::firmware_text(*readings.firmware_version)));
  }
  if (member.id_is_known && member.static_node_id.value_or(0) != 0 &&
      *member.static_node_id != member.id.value()) {
    out.push_back(say<texts::warn_static_id_differs>(*member.static_node_id));
  }
  return out;
}

bool is_tool(const Finding& node) {
  return !node.servo.is_servo && state::is_tool_id(node.servo.id);
}

std::vector<NodeId> commanders(const Roster& roster) {
  std::vector<NodeId> out;
  for (const auto& [id, commander] : roster.commanders()) {
    out.push_back(id);
  }
  return out;
}

std::vector<std::string> others(const Roster& roster) {
  std::vector<std::string> out;
  for (const NodeId id : roster.allocators()) {
    out.push_back(say<texts::allocates>(id.value()));
  }
  for (const NodeId id : commanders(roster)) {
    out.push_back(say<texts::commands_servos>(id.value()));
  }
  if (const auto by = roster.said_armed()) {
    out.push_back(say<texts::says_armed>(by->value()));
  }
  return out;
}

std::vector<std::string> notes_before_writing(const Roster& roster) {
  std::vector<std::string> out = others(roster);
  std::vector<Conflict> shared;
  const auto servo_id = [](const Member& member) {
    const auto id = member.commanded_id();
    return id.value_or(0) != 0 ? id : std::nullopt;
  };
  find_shared<texts::doubled_servo_id>(roster, Code::duplicate_servo_id, servo_id, shared);
  std::ranges::transform(shared, std::back_inserter(out), &Conflict::text);
  return out;
}

Time heard_until(const Session& session) {
  return session.is_replay() ? session.roster().last_heard() : session.now();
}

Findings gather(const Roster& roster, const Targets& targets, const bla::Profiles& profiles,
                Time now, const std::set<NodeId>& gone) {
  Findings findings{&roster, {}, {}};
  for (const auto& [id, member] : roster.members()) {
    if (!roster.heard(id) || roster.has_moved(member) ||
        (targets.given && !targets.mean(member, profiles))) {
      continue;
    }
    if (roster.is_doubled(id)) {
      std::ranges::move(units_on(roster, member), std::back_inserter(findings.nodes));
    } else {
      findings.nodes.push_back(finding(member, now, gone.contains(id)));
    }
  }
  findings.conflicts = find_conflicts(roster);
  return findings;
}

} // namespace blactl::fleet
