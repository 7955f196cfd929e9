#pragma once
// ArrayCommand as it tells a servo one of its registers 0x00-0x02 (tables 2-20, 2-21).

#include "blactl/bla/address.hpp"
#include "blactl/dronecan/types.hpp"

#include <cstdint>

namespace blactl::fleet {

/// `raw` for `command` (0x00, 0x01 or 0x02) to the servo with this servo ID alone.
[[nodiscard]] dronecan::ArrayCommand array_command(std::uint8_t servo_id, bla::Address command,
                                                   std::int64_t raw);

/// What a servo takes from that: numbers are half precision on the wire. unproven: that it rounds
/// to the nearest.
[[nodiscard]] std::int64_t told_by_array(bla::Address command, std::int64_t raw);

} // namespace blactl::fleet
