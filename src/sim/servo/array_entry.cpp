#include "blactl/sim/servo/array_entry.hpp"

#include <algorithm>
#include <cmath>

namespace blactl::sim {
namespace {

constexpr std::uint8_t unitless = 0;

/// The value of a command, if valid (requirement 107, table 2-21).
std::optional<double> number(const dronecan::ArrayCommand::Command& command,
                             const Behaviour& behaviour) {
  const double value = command.value;
  if (!std::isfinite(value)) {
    return behaviour.not_a_number == NotANumber::zero ? std::optional(0.0) : std::nullopt;
  }
  if (command.command_type != unitless || behaviour.beyond_unitless == BeyondUnitless::limits) {
    return value;
  }
  const double inside = std::clamp(value, -1.0, 1.0);
  return inside == value || behaviour.beyond_unitless == BeyondUnitless::clamp
             ? std::optional(inside)
             : std::nullopt;
}

} // namespace

std::optional<MotionCommand> motion_command(const dronecan::ArrayCommand::Command& command,
                                            const Behaviour& behaviour) {
  constexpr double half_turn_decideg = 1800; // at UNITLESS 1
  constexpr double position_decideg = 1000;  // at POSITION 1
  const auto value = number(command, behaviour);
  if (!value) {
    return std::nullopt;
  }
  const auto rounded = [value](double scale) {
    return static_cast<std::int64_t>(std::llround(*value * scale));
  };
  switch (command.command_type) {
  case unitless: return MotionCommand{bla::address::command_angle, rounded(half_turn_decideg)};
  case 1: return MotionCommand{bla::address::command_angle, rounded(position_decideg)};
  case 2: return MotionCommand{bla::address::command_torque, rounded(1)};
  case 3: return MotionCommand{bla::address::command_speed, rounded(1)};
  default: return std::nullopt;
  }
}

bool addresses(const dronecan::ArrayCommand::Command& command, std::int64_t servo_id,
               const Behaviour& behaviour) {
  constexpr std::uint8_t every_servo = 255;
  const bool has_id = command.actuator_id != 0 || behaviour.obeys_servo_id_0;
  return command.actuator_id == every_servo || (has_id && command.actuator_id == servo_id);
}

} // namespace blactl::sim
