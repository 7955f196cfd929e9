#pragma once
// The PWM input of -AB models: pulses to commands (4.29, 4.30).

#include "blactl/sim/servo/array_entry.hpp"
#include "blactl/sim/servo/memory.hpp"

#include <cstdint>
#include <optional>

namespace blactl::sim {

/// The result of a pulse.
struct PulseReading {
  std::int64_t notices = 0;               ///< bits 20-22 of 0x19
  std::optional<MotionCommand> command{}; ///< empty: no valid pulse
};

/// For models and firmware with a PWM input. A pulse outside the range is treated as none
/// (requirement 158). `end_points_move`: Behaviour::pwm_end_points_move.
[[nodiscard]] PulseReading read_pulse(std::optional<std::int64_t> width_us, const Memory& registers,
                                      bool end_points_move);

} // namespace blactl::sim
