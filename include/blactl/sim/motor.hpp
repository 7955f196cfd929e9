#pragma once
// The motor of a model, and how the registers tune it.

#include "blactl/sim/controller.hpp"
#include "blactl/sim/registers.hpp"
#include "blactl/sim/scenario.hpp"

#include <cstdint>

namespace blactl::sim {

/// What a model and its firmware have.
struct Motor {
  std::int64_t nominal_decivolt = 0;
  std::int64_t full_speed = 0;   ///< requirement 123
  std::int64_t full_current = 0; ///< the default of 0x2A, which is 100 %; 0: there is no 0x2A
  bool has_boost = false;        ///< 0x2F
};

[[nodiscard]] Motor motor_of(const ServoSetup& setup);

/// The present tuning. A soft start has limits of its own and 0x25 on (requirement 140).
[[nodiscard]] Tuning tuning_of(const Motor& motor, const Registers& registers, bool soft_start);

} // namespace blactl::sim
