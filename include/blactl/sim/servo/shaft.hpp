#pragma once
// The output shaft of a simulated servo: how it turns under what pushes it. Whole numbers only, so
// that every machine computes the same.

#include "blactl/sim/servo/world.hpp"

#include <cstdint>

namespace blactl::sim {

/// Angles are counted in millionths of 0.1 deg, speeds in the same a millisecond, efforts of the
/// motor in millionths of the greatest. All positive clockwise.
inline constexpr std::int64_t angle_per_decideg = 1'000'000;
inline constexpr std::int64_t speed_per_rpm = 60'000; ///< 1 rpm is 0.06 x 0.1 deg in 1 ms
inline constexpr std::int64_t full_effort = 1'000'000;
inline constexpr std::int64_t effort_per_percent = 10'000;

/// What the motor does to the shaft.
struct Drive {
  enum class Kind : std::uint8_t { off, brake, on };

  Kind kind = Kind::off;
  std::int64_t effort = 0; ///< only of `on`

  friend bool operator==(const Drive&, const Drive&) = default;
};

/// unproven: all numbers of the mechanics are believable, none is of a data sheet. The speed
/// follows what pushes with a time constant of 5 ms; friction holds what pushes less, least with
/// the motor on, most with the brake.
struct Shaft {
  std::int64_t angle = 0; ///< CW of the horn notch, all turns that it was turned
  std::int64_t speed = 0;

  /// One millisecond. `full_speed`: what all effort at the nominal supply reaches without load;
  /// `push`: the motor's effort at the present supply.
  void step(Drive::Kind kind, std::int64_t push, const World& world, std::int64_t full_speed);

  friend bool operator==(const Shaft&, const Shaft&) = default;
};

} // namespace blactl::sim
