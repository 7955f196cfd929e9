#include "blactl/sim/servo/pwm_input.hpp"

#include "sim/servo/names.hpp"

namespace blactl::sim {

PulseReading read_pulse(std::optional<std::int64_t> width_us, const Memory& registers,
                        bool end_points_move) {
  if (!width_us) {
    return {.notices = fault::pwm_missing};
  }
  const std::int64_t range = registers.value(address::pwm_range);
  const std::int64_t offset = *width_us - registers.value(address::pwm_neutral);
  PulseReading reading;
  reading.notices |= offset <= -range ? fault::pwm_too_short : 0;
  reading.notices |= offset >= range ? fault::pwm_too_long : 0;
  const bool at_end = offset == range || offset == -range;
  if (reading.notices == 0 || (at_end && end_points_move)) {
    const bool speed = registers.value(address::pwm_mode) == 1;
    reading.command = {speed ? address::command_speed : address::command_angle,
                       registers.value(address::pwm_output_range) * offset / range};
  }
  return reading;
}

} // namespace blactl::sim
