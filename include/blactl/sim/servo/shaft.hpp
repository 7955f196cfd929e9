#pragma once
// The output shaft of a simulated servo: its motion under the forces on it. Integers only, so that
// every machine computes the same.

#include "blactl/sim/servo/world.hpp"

#include <cstdint>

namespace blactl::sim {

/// Angles are in millionths of 0.1 deg, speeds in the same per millisecond, efforts of the motor in
/// millionths of the maximum. All are positive clockwise.
inline constexpr std::int64_t angle_per_decideg = 1'000'000;
inline constexpr std::int64_t speed_per_rpm = 60'000; ///< 1 rpm is 0.06 x 0.1 deg per 1 ms
inline constexpr std::int64_t full_effort = 1'000'000;
inline constexpr std::int64_t effort_per_percent = 10'000;

/// The motor's action on the shaft.
struct Drive {
  enum class Kind : std::uint8_t { off, brake, on };

  Kind kind = Kind::off;
  std::int64_t effort = 0; ///< for `on` only

  friend bool operator==(const Drive&, const Drive&) = default;
};

/// unproven: all constants of the mechanics are plausible, none is from a data sheet. The speed
/// follows the driving effort with a time constant of 5 ms; friction holds against smaller efforts,
/// least with the motor on, most with the brake.
struct Shaft {
  std::int64_t angle = 0; ///< CW of the horn notch, over all turns
  std::int64_t speed = 0;

  /// Computes one millisecond. `full_speed`: the speed at full effort and nominal supply without
  /// load; `push`: the motor's effort at the present supply.
  void step(Drive::Kind kind, std::int64_t push, const World& world, std::int64_t full_speed);

  friend bool operator==(const Shaft&, const Shaft&) = default;
};

} // namespace blactl::sim
