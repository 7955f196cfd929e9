#pragma once
// The effect of a restart on the shaft and the load (contract, section 4).

#include "blactl/bla/values.hpp"

#include <cstdint>

namespace blactl::bla {

/// The motion of the shaft during a restart (4.11, 4.14).
enum class RestartMotion : std::uint8_t {
  none, ///< torque is off before and after
  soft, ///< the output drops, then the shaft runs slowly to 0 deg
  hard, ///< the output drops, then torque returns where the shaft is
};

/// `configuration`: the settings the servo starts with. Unknown ones are assumed to be the worst.
[[nodiscard]] RestartMotion restart_motion(const Values& configuration);

} // namespace blactl::bla
