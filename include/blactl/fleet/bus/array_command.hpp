#pragma once
// ArrayCommand for one of a servo's registers 0x00-0x02 (tables 2-20, 2-21).

#include "blactl/bla/address.hpp"
#include "blactl/dronecan/types.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Sets `command` (0x00, 0x01 or 0x02) to `raw` in the servo with this servo ID only.
[[nodiscard]] dronecan::ArrayCommand array_command(std::uint8_t servo_id, bla::Address command,
                                                   std::int64_t raw);

/// The value that a servo takes from it: numbers are half precision on the wire. unproven: that it
/// rounds to the nearest.
[[nodiscard]] std::int64_t told_by_array(bla::Address command, std::int64_t raw);

/// A value of one of the registers 0x00-0x02.
struct MotionCommand {
  bla::Address reg;
  std::int64_t raw = 0;
};

/// The command that a servo takes from an entry, UNITLESS as an angle; empty: the type is not one
/// of table 2-21, or the value is not a number.
[[nodiscard]] std::optional<MotionCommand>
motion_command(const dronecan::ArrayCommand::Command& entry);

} // namespace blactl::fleet
