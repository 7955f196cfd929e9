// Motion: commands to actuators, their state, and whether they are armed.

#include "blactl/dronecan/types.hpp"

#include "dronecan/wire.hpp"

#include <algorithm>

namespace blactl::dronecan {
namespace {

constexpr std::size_t command_size = 4;
constexpr std::uint8_t max_power_rating = 127;

} // namespace

Payload ArrayCommand::encode() const {
  Payload payload;
  for (const auto& command : std::span(commands).first(std::min(commands.size(), max_commands))) {
    payload.append(command.actuator_id);
    payload.append(command.command_type);
    put_float16(payload, command.value);
  }
  return payload;
}

// A truncated command makes the whole message invalid: the sender's intent is unknown.
std::optional<ArrayCommand> ArrayCommand::decode(Bytes payload) {
  const auto count = payload.size() / command_size;
  if (count > max_commands || payload.size() % command_size != 0) {
    return std::nullopt;
  }
  Reader reader(payload);
  ArrayCommand array;
  array.commands.resize(count);
  for (auto& command : array.commands) {
    command.actuator_id = reader.u8();
    command.command_type = reader.u8();
    command.value = reader.float16();
  }
  return array;
}

Payload ActuatorStatus::encode() const {
  Payload payload;
  payload.append(actuator_id);
  put_float16(payload, position);
  put_float16(payload, force);
  put_float16(payload, speed);
  payload.append(std::min(power_rating_pct, max_power_rating));
  return payload;
}

std::optional<ActuatorStatus> ActuatorStatus::decode(Bytes payload) {
  Reader reader(payload);
  ActuatorStatus status;
  status.actuator_id = reader.u8();
  status.position = reader.float16();
  status.force = reader.float16();
  status.speed = reader.float16();
  status.power_rating_pct = reader.u8() & max_power_rating;
  return reader.ok() ? std::optional(status) : std::nullopt;
}

Payload ArmingStatus::encode() const {
  Payload payload;
  payload.append(status);
  return payload;
}

std::optional<ArmingStatus> ArmingStatus::decode(Bytes payload) {
  Reader reader(payload);
  const ArmingStatus arming{.status = reader.u8()};
  return reader.ok() ? std::optional(arming) : std::nullopt;
}

} // namespace blactl::dronecan
