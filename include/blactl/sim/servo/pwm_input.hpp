#pragma once
// The PWM input of -AB models: pulses to commands (4.29, 4.30).

#include "blactl/sim/servo/command.hpp"
#include "blactl/sim/servo/registers.hpp"

#include <cstdint>
#include <optional>

namespace blactl::sim {

/// What a pulse means.
struct PulseReading {
  std::int64_t notices = 0;               ///< bits 20-22 of 0x19
  std::optional<MotionCommand> command{}; ///< empty: no valid pulse
};

/// Of a model and firmware with a PWM input. A pulse outside the range counts as none (requirement
/// 158). `end_points_move`: Behaviour::pwm_end_points_move.
[[nodiscard]] PulseReading read_pulse(std::optional<std::int64_t> width_us,
                                      const Registers& registers, bool end_points_move);

} // namespace blactl::sim
