#pragma once
// The fault bits of a simulated servo (0x19-0x1B), and the faults that stop the motor (4.7, 4.8,
// 4.12).

#include "blactl/sim/servo/memory.hpp"
#include "blactl/sim/servo/servo_setup.hpp"
#include "blactl/sim/servo/world.hpp"

#include <cstdint>

namespace blactl::sim {

/// 0x19, 0x1A and 0x1B.
struct Faults {
  std::int64_t notice = 0, warning = 0, failure = 0;
};

/// From the readings 0x08-0x0C, the commands and the limits in `registers`, or those of a soft
/// start (requirement 180). Without the PWM input.
[[nodiscard]] Faults present_faults(const Memory& registers, const World& world,
                                    const Behaviour& behaviour, bool soft_start);

/// Requirements 161, 170: temperature or voltage beyond a limit, or a present failure. Bits that
/// only show the cause of the last restart (4.12, note 2) do not count, unless Behaviour says so.
/// The actual temperature is compared, not the reading: 0x0B ends at -40 degC, which is the
/// factory's lower limit.
[[nodiscard]] bool stops_motor(const Memory& registers, const World& world,
                               const Behaviour& behaviour, std::int64_t failures);

} // namespace blactl::sim
