// Who is monitored, and who of those that are meant is missing.

#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/live/monitor.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

namespace blactl::fleet {

using dronecan::NodeId;

std::vector<LiveServo> Monitor::servos(Time now) const {
  std::vector<LiveServo> out;
  for (const auto& [id, member] : session_.roster().members()) {
    const auto node = nodes_.find(id);
    if (node != nodes_.end() && session_.roster().heard(id) && !member.is_foreign() &&
        is_meant(member, node->second) && !session_.roster().has_moved(member)) {
      out.push_back(live(member, node->second, now));
    }
  }
  return out;
}

/// At present: one that has just restarted is unknown until it has responded.
bool Monitor::is_met(const Selector& selector) const {
  return std::ranges::any_of(nodes_, [&](const auto& entry) {
    const Member* member = session_.roster().find(entry.first);
    return member != nullptr && selector.matches(servo(*member, entry.second), profiles_);
  });
}

std::vector<Error> Monitor::missing(Time now) const {
  const Roster& roster = session_.roster();
  std::vector<Error> errors;
  for (const NodeId id : targets_.ids) {
    if (!roster.heard(id)) {
      errors.push_back(session_.is_replay() ? unrecorded(id) : silent(roster, id));
    } else if (const Member& member = roster.member(id); member.is_foreign()) {
      errors.push_back(not_a_servo(id, member.info->name));
    }
  }
  std::set<NodeId> shared; // an unmet one may be one of those
  for (const Selector& selector : targets_.selectors) {
    if (!is_met(selector)) {
      shared = roster.doubled();
      if (shared.empty() && !met_.contains(selector.text)) {
        errors.push_back(nothing_matches(roster, selector));
      }
    }
  }
  for (const NodeId id : shared) {
    errors.push_back(doubled(roster, id));
  }
  const auto live = servos(now);
  if (errors.empty() && targets_.need_search() && live.empty()) {
    errors.push_back(no_servo(roster));
  }
  for (const LiveServo& servo : live) {
    if (!targets_.mean_all() && servo.is_gone && !servo.is_doubled) {
      const std::uint8_t id = servo.servo.id.value();
      errors.push_back(
          {Code::timeout, say<texts::node_gone>(id), say<texts::no_answer_hint>(), id});
    }
  }
  return errors;
}

} // namespace blactl::fleet
