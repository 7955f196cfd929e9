#pragma once
// How a simulated servo makes the motor follow a command (4.15, 4.18, 4.20-4.28, 4.32,
// 4.33).

#include "blactl/sim/servo/shaft.hpp"

#include <algorithm>
#include <cstdint>

namespace blactl::sim {

/// Which of 0x00, 0x01 and 0x02 rules.
enum class Mode : std::uint8_t { angle, speed, torque };

/// What the shaft shall do: an angle, a speed or an effort in the units of Shaft, as the servo
/// counts them (4.16, 4.36).
struct Aim {
  Mode mode = Mode::angle;
  std::int64_t value = 0;
};

/// Where the shaft is, counted the same way.
struct Position {
  std::int64_t angle = 0, speed = 0;
};

/// A gain as it is to what is usual; 0/n is none.
struct Ratio {
  std::int64_t part = 1, whole = 1;

  [[nodiscard]] std::int64_t of(std::int64_t value) const { return value * part / whole; }
};

/// The registers that form the motion, in the units of Shaft.
struct Tuning {
  bool cascade = false;                ///< 0x25: angle, speed, torque one after the other
  bool smooth = false;                 ///< 0x22
  std::int64_t p_gain = 0, d_gain = 0; ///< 0x2C, 0x2D
  bool boost_in_dead_band = false;
  std::int64_t dead_band = 0, boost = 0;      ///< 0x2E, 0x2F
  std::int64_t speed_cw = 0, speed_ccw = 0;   ///< 0x3A, 0x3B
  std::int64_t effort_cw = 0, effort_ccw = 0; ///< 0x3C, 0x3D
  std::int64_t effort_limit = full_effort;    ///< from 0x2A; may be more than full_effort
  std::int64_t full_speed = 0;
  Ratio speed_p{}, speed_i{};                ///< 0x30, 0x31, to the default of the model
  std::int64_t speed_dead_band = 0;          ///< 0x32
  std::int64_t integral_limit = full_effort; ///< from 0x33

  /// 100 % of torque: all that 0x2A lets through, if it is more than usual.
  [[nodiscard]] std::int64_t whole_effort() const { return std::max(full_effort, effort_limit); }
};

class Controller {
 public:
  /// One millisecond of control.
  [[nodiscard]] Drive step(const Aim& aim, const Position& position, const Tuning& tuning);

  /// Forgets what it follows: the next step begins where the shaft is.
  void rest() { follows_ = false; }

  friend bool operator==(const Controller&, const Controller&) = default;

 private:
  [[nodiscard]] std::int64_t speed_control(std::int64_t wanted, const Position& position,
                                           const Tuning& tuning);
  void follow(const Aim& aim, const Position& position, bool smooth);

  bool follows_ = false;
  Mode mode_ = Mode::angle;
  std::int64_t reference_ = 0; ///< the smoothed command
  std::int64_t integral_ = 0;  ///< effort that the speed control has built up
};

/// Requirement 172: no effort inside the dead band, unless boost works there; beyond it gain and
/// boost, at most all that the motor has.
/// unproven: 1 % for each 0.1 deg at a gain of 40, and that the three add up so.
[[nodiscard]] std::int64_t angle_effort(std::int64_t deviation, const Tuning& tuning);

} // namespace blactl::sim
