#include "blactl/fleet/doctor/motion.hpp"

#include <algorithm>

namespace blactl::fleet {

bool has_servo_id(const Roster& roster, std::uint8_t servo_id) {
  return std::ranges::any_of(roster.members(), [&](const auto& entry) {
    return entry.second.servo_id == servo_id || entry.second.actuator_id == servo_id;
  });
}

HeardCommands commands_to(const Servo& servo, const Roster& roster, Time now) {
  constexpr std::uint8_t every_servo = 255;
  const auto actuator_id = roster.member(servo.id).actuator_id;
  HeardCommands heard;
  for (const auto& [source, commander] : roster.commanders()) {
    const auto by_node = commander.nodes.find(servo.id);
    if (by_node != commander.nodes.end() && by_node->second.heard.counts(now)) {
      heard.to_it.push_back({source, by_node->second});
    }
    for (const auto& [servo_id, command] : commander.servo_ids) {
      // register and actuator.Status may differ: it is not known which of them it obeys
      const bool is_its =
          servo_id == every_servo || servo.servo_id == servo_id || actuator_id == servo_id;
      if (!command.heard.counts(now)) {
        continue;
      }
      if (is_its) {
        heard.to_it.push_back({source, command});
      } else {
        heard.to_others.emplace(servo_id, source);
      }
    }
  }
  for (const auto& [servo_id, source] : heard.to_others) {
    if (!has_servo_id(roster, servo_id)) {
      heard.vacant.insert(servo_id);
    }
  }
  return heard;
}

} // namespace blactl::fleet
