#include "blactl/sim/command.hpp"

#include <cmath>

namespace blactl::sim {

std::optional<MotionCommand> motion_command(const dronecan::ArrayCommand::Command& command,
                                            NotANumber not_a_number) {
  constexpr double half_turn_decideg = 1800; // UNITLESS 1
  constexpr double position_decideg = 1000;  // POSITION 1
  double value = command.value;
  if (!std::isfinite(value)) {
    if (not_a_number == NotANumber::ignore) {
      return std::nullopt;
    }
    value = 0;
  }
  const auto rounded = [value](double scale) {
    return static_cast<std::int64_t>(std::llround(value * scale));
  };
  switch (command.command_type) {
  case 0: return MotionCommand{bla::address::command_angle, rounded(half_turn_decideg)};
  case 1: return MotionCommand{bla::address::command_angle, rounded(position_decideg)};
  case 2: return MotionCommand{bla::address::command_torque, rounded(1)};
  case 3: return MotionCommand{bla::address::command_speed, rounded(1)};
  default: return std::nullopt;
  }
}

bool addresses(const dronecan::ArrayCommand::Command& command, std::int64_t servo_id) {
  constexpr std::uint8_t every_servo = 255;
  return command.actuator_id == every_servo || command.actuator_id == servo_id;
}

} // namespace blactl::sim
