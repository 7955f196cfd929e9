#pragma once
// The motor control of a simulated servo (4.15, 4.18, 4.20-4.28, 4.32, 4.33).

#include "blactl/sim/servo/shaft.hpp"

#include <algorithm>
#include <cstdint>

namespace blactl::sim {

/// The active one of 0x00, 0x01 and 0x02.
enum class Mode : std::uint8_t { angle, speed, torque };

/// The target of the shaft: an angle, a speed or an effort in the units of Shaft, in the servo's
/// own count (4.16, 4.36).
struct Aim {
  Mode mode = Mode::angle;
  std::int64_t value = 0;
};

/// The position of the shaft, in the same count.
struct Position {
  std::int64_t angle = 0, speed = 0;
};

/// A gain relative to its usual value; 0/n is none.
struct Ratio {
  std::int64_t part = 1, whole = 1;

  [[nodiscard]] std::int64_t of(std::int64_t value) const { return value * part / whole; }
};

/// The registers that form the motion, in the units of Shaft.
struct Tuning {
  bool cascade = false;                ///< 0x25: nested angle, speed and torque loops
  bool smooth = false;                 ///< 0x22
  std::int64_t p_gain = 0, d_gain = 0; ///< 0x2C, 0x2D
  bool boost_in_dead_band = false;
  std::int64_t dead_band = 0, boost = 0;      ///< 0x2E, 0x2F
  std::int64_t speed_cw = 0, speed_ccw = 0;   ///< 0x3A, 0x3B
  std::int64_t effort_cw = 0, effort_ccw = 0; ///< 0x3C, 0x3D
  std::int64_t effort_limit = full_effort;    ///< from 0x2A; may be more than full_effort
  std::int64_t full_speed = 0;
  Ratio speed_p{}, speed_i{};                ///< 0x30, 0x31, relative to the default of the model
  std::int64_t speed_dead_band = 0;          ///< 0x32
  std::int64_t integral_limit = full_effort; ///< from 0x33

  /// 100 % of torque: all that 0x2A allows, if it is more than usual.
  [[nodiscard]] std::int64_t whole_effort() const { return std::max(full_effort, effort_limit); }
};

class Controller {
 public:
  /// Computes one millisecond of control.
  [[nodiscard]] Drive step(const Aim& aim, const Position& position, const Tuning& tuning);

  /// Resets the reference: the next step begins at the present position of the shaft.
  void rest() { follows_ = false; }

  friend bool operator==(const Controller&, const Controller&) = default;

 private:
  [[nodiscard]] std::int64_t speed_control(std::int64_t wanted, const Position& position,
                                           const Tuning& tuning);
  void follow(const Aim& aim, const Position& position, bool smooth);

  bool follows_ = false;
  Mode mode_ = Mode::angle;
  std::int64_t reference_ = 0; ///< the smoothed command
  std::int64_t integral_ = 0;  ///< effort accumulated by the speed control
};

/// Requirement 172: no effort inside the dead band, unless boost works there; beyond it gain and
/// boost, limited to the motor's full effort. unproven: 1 % for each 0.1 deg at a gain of 40, and
/// that the three add up so.
[[nodiscard]] std::int64_t angle_effort(std::int64_t deviation, const Tuning& tuning);

} // namespace blactl::sim
