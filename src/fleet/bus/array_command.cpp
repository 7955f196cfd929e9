#include "blactl/fleet/bus/array_command.hpp"

#include <array>
#include <cmath>

namespace blactl::fleet {

namespace {

/// An entry of table 2-21, with the register value of 1.
struct ArrayEntry {
  std::uint8_t type;
  float scale;
};

constexpr ArrayEntry entry_of(bla::Address command) {
  constexpr ArrayEntry position{1, 1000}, force{2, 1}, speed{3, 1};
  return command == bla::address::command_angle   ? position
         : command == bla::address::command_speed ? speed
                                                  : force;
}

} // namespace

dronecan::ArrayCommand array_command(std::uint8_t servo_id, bla::Address command,
                                     std::int64_t raw) {
  const ArrayEntry entry = entry_of(command);
  return {{{.actuator_id = servo_id,
            .command_type = entry.type,
            .value = static_cast<float>(raw) / entry.scale}}};
}

std::int64_t told_by_array(bla::Address command, std::int64_t raw) {
  const float sent = static_cast<float>(raw) / entry_of(command).scale;
  const float told = dronecan::from_float16(dronecan::to_float16(sent));
  return std::isfinite(told) ? std::llround(told * entry_of(command).scale) : 0;
}

std::optional<MotionCommand> motion_command(const dronecan::ArrayCommand::Command& entry) {
  constexpr float unitless_scale = 1800; // +-1 is +-180 deg (table 2-21)

  struct Meaning {
    bla::Address reg;
    float scale;
  };

  using namespace bla::address;
  const std::array meanings{Meaning{command_angle, unitless_scale},
                            Meaning{command_angle, entry_of(command_angle).scale},
                            Meaning{command_torque, entry_of(command_torque).scale},
                            Meaning{command_speed, entry_of(command_speed).scale}};
  if (entry.command_type >= meanings.size() || !std::isfinite(entry.value)) {
    return std::nullopt;
  }
  const Meaning& meaning = meanings.at(entry.command_type);
  return MotionCommand{meaning.reg, std::llround(entry.value * meaning.scale)};
}

} // namespace blactl::fleet
