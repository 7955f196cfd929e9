#pragma once
// The bits of 0x19 (notice), 0x1A (warning) and 0x1B (failure) that the program itself must know
// (4.12); their meaning for people is in the profiles.

#include <cstdint>

namespace blactl::bla::fault {

inline constexpr std::int64_t angle_cw = 1 << 8, angle_ccw = 1 << 9;
inline constexpr std::int64_t speed_cw = 1 << 10, speed_ccw = 1 << 11;
inline constexpr std::int64_t torque_cw = 1 << 12, torque_ccw = 1 << 13;
inline constexpr std::int64_t pwm_missing = 1 << 20;
inline constexpr std::int64_t pwm_too_short = 1 << 21, pwm_too_long = 1 << 22;
inline constexpr std::int64_t pwm_input = pwm_missing | pwm_too_short | pwm_too_long;

inline constexpr std::int64_t magnet_weak = 1 << 4, magnet_strong = 1 << 5;
inline constexpr std::int64_t temperature_high = 1 << 8, temperature_low = 1 << 9;
inline constexpr std::int64_t voltage_high = 1 << 10, voltage_low = 1 << 11;
inline constexpr std::int64_t rom_unreadable = 1 << 15;

inline constexpr std::int64_t motor_driver = 1 << 0, motor = 1 << 1, angle_sensor = 1 << 5;
inline constexpr std::int64_t clock = 1 << 8, watchdog = 1 << 9, memory = 1 << 11;

/// Note *2: they show why the servo last restarted by itself.
inline constexpr std::int64_t restart_warnings = rom_unreadable;
inline constexpr std::int64_t restart_failures = clock | watchdog | memory;

/// Hardware failures; the specification does not say whether they persist (4.12).
inline constexpr std::int64_t hardware_failures = motor_driver | motor | angle_sensor;

} // namespace blactl::bla::fault
