#pragma once
// The surroundings of one simulated servo: its supply, its load, a hand on its shaft, its PWM
// input.

#include <cstdint>
#include <optional>

namespace blactl::sim {

struct ServoSetup;

/// The state of the angle sensor's magnet (bits 4, 5 of 0x1A and bit 5 of 0x1B).
enum class Magnet : std::uint8_t { fine, weak, strong, unreadable };

/// A plain value: to change it, take Servo::world(), modify the copy and pass it to
/// Servo::surround(). Loads are -1000 to 1000 %, hands at -360,000,000 to 360,000,000.
struct World {
  static constexpr std::int64_t room_celsius = 25;

  bool plugged = true;                        ///< false: its plug with supply and CAN is pulled
  std::int64_t supply_decivolt = 0;           ///< 0x0C; 30 or less is too low to run (4.8)
  std::int64_t board_celsius = room_celsius;  ///< 0x0B
  std::int64_t load_percent = 0;              ///< of the greatest torque; positive pushes CW
  std::optional<std::int64_t> hand_decideg{}; ///< a hand turns the shaft there by the shortest way
                                              ///< and holds it: 0.1 deg CW of the horn notch
  bool stuck = false;                         ///< the shaft is blocked, whatever the effort
  std::optional<std::int64_t> pulse_us{};     ///< width at the PWM input; empty: no signal
  Magnet magnet = Magnet::fine;
  bool driver_stopped = false;    ///< 0x1B bit 0
  bool rotation_abnormal = false; ///< 0x1B bit 1
  /// Bits of 0x19, 0x1A and 0x1B that are set in any case.
  std::int64_t notices = 0, warnings = 0, failures = 0;

  [[nodiscard]] bool powers() const { return plugged && supply_decivolt > 30; }

  friend bool operator==(const World&, const World&) = default;
};

/// The nominal supply of a model, inside its default limits.
[[nodiscard]] std::int64_t nominal_decivolt(const ServoSetup& setup);

/// The surroundings at the beginning of a scenario: the nominal supply at room temperature without
/// load or PWM, and the values of "ram" for 0x0B, 0x0C and 0x19-0x1B. With bit 21 or 22 of 0x19
/// there is a pulse, too short or too long; the other bits are simply set.
[[nodiscard]] World world_of(const ServoSetup& setup);

} // namespace blactl::sim
