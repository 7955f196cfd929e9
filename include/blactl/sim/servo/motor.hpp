#pragma once
// The motor of a model, and how the registers tune it.

#include "blactl/sim/servo/controller.hpp"
#include "blactl/sim/servo/memory.hpp"
#include "blactl/sim/servo/servo_setup.hpp"

#include <cstdint>

namespace blactl::sim {

/// The properties of a model and its firmware.
struct Motor {
  std::int64_t nominal_decivolt = 0;
  std::int64_t full_speed = 0;   ///< requirement 123
  std::int64_t full_current = 0; ///< the default of 0x2A, which is 100 %; 0: no 0x2A
  bool has_boost = false;        ///< 0x2F
  // The defaults of 0x30, 0x31 and 0x33, for which the speed control is tuned.
  std::int64_t usual_speed_p = 1, usual_speed_i = 1, usual_integral_limit = 1;
};

[[nodiscard]] Motor motor_of(const ServoSetup& setup);

/// The present tuning. A soft start has its own limits and works with 0x25 on (requirement 140).
[[nodiscard]] Tuning tuning_of(const Motor& motor, const Memory& registers, bool soft_start);

} // namespace blactl::sim
