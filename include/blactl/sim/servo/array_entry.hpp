#pragma once
// The commands of ArrayCommand for a servo, as registers (tables 2-20, 2-21).

#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/servo/behaviour.hpp"

#include <cstdint>
#include <optional>

namespace blactl::sim {

/// A value for 0x00, 0x01 or 0x02.
struct MotionCommand {
  bla::Address address;
  std::int64_t value = 0;

  friend bool operator==(const MotionCommand&, const MotionCommand&) = default;
};

/// Empty: an unknown type, not a number, or UNITLESS beyond 1 (requirements 104, 107; the last two
/// depend on Behaviour).
[[nodiscard]] std::optional<MotionCommand>
motion_command(const dronecan::ArrayCommand::Command& command, const Behaviour& behaviour);

/// Requirements 98, 99: whether a command is for the servo with this 0x45. Behaviour: ID 0.
[[nodiscard]] bool addresses(const dronecan::ArrayCommand::Command& command, std::int64_t servo_id,
                             const Behaviour& behaviour);

} // namespace blactl::sim
