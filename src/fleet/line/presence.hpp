#pragma once
// How long a silence of a servo on a bench is.

#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/roster.hpp"

#include <chrono>

namespace blactl::fleet {

/// After a silence of this length a servo has left: it sends actuator.Status ten times a second.
inline constexpr Duration away_time = std::chrono::milliseconds(500);

/// For an operator to take a servo off, and for the next one not to pass for it.
inline constexpr Duration off_time = std::chrono::seconds(3);

[[nodiscard]] inline bool may_be_bla_servo(const Member& member) {
  return member.is_servo || (member.sends_actuator_status() && !member.is_foreign());
}

} // namespace blactl::fleet
