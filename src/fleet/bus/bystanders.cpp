#include "blactl/fleet/bus/bystanders.hpp"

#include "blactl/state/local_node_id.hpp"

namespace blactl::fleet {

Bystanders::Bystanders(const Roster& roster) {
  for (const auto& [id, member] : roster.members()) {
    boots_[id] = member.boots;
  }
}

std::optional<dronecan::NodeId> Bystanders::obeys(const Roster& roster, const Servo& servo,
                                                  std::int64_t servo_id) const {
  std::optional<dronecan::NodeId> suspect;
  for (const auto& [id, member] : roster.members()) {
    const bool is_itself = id == servo.id || (servo.unique_id && member.is_unit(*servo.unique_id));
    if (is_itself || state::is_tool_id(id)) {
      continue;
    }
    if (member.actuator_id == servo_id) {
      return id;
    }
    const auto before = boots_.find(id);
    if (before == boots_.end() || before->second != member.boots) {
      suspect = id;
    }
  }
  return suspect;
}

} // namespace blactl::fleet
