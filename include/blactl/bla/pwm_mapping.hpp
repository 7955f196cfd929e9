#pragma once
// The mapping from the pulse at the PWM input to a command: 0x34-0x37 (4.29, 4.30).

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// All four registers, and the limits that cut off its commands, if known.
struct PwmMapping {
  std::int64_t neutral_us = 0;
  std::int64_t range_us = 0;                           ///< to either side of neutral
  std::int64_t output_raw = 0;                         ///< at the ends of the range: 0.1 deg or rpm
  std::int64_t mode = 0;                               ///< 0x37: 0 angle, 1 speed
  std::optional<std::int64_t> limit_cw{}, limit_ccw{}; ///< 0x38/0x39, or 0x3A/0x3B
  bool is_idle = false; ///< in speed mode while 0x25 is off: pulses have no effect

  [[nodiscard]] bool is_angle() const { return mode == 0; }

  [[nodiscard]] std::int64_t shortest_us() const { return neutral_us - range_us; }

  [[nodiscard]] std::int64_t longest_us() const { return neutral_us + range_us; }

  /// The command for a pulse, in units of 0x00 or 0x01; between two steps the one nearer to 0
  /// (unproven). Empty: the servo ignores the pulse.
  [[nodiscard]] std::optional<std::int64_t> command(std::int64_t pulse_us) const;

  /// The same, clamped to the limits.
  [[nodiscard]] std::optional<std::int64_t> limited_command(std::int64_t pulse_us) const;

  /// The pulse below which limit_ccw cuts off the command; empty: it does not.
  [[nodiscard]] std::optional<std::int64_t> cut_off_below_us() const;

  /// The pulse above which limit_cw cuts off the command; empty: it does not.
  [[nodiscard]] std::optional<std::int64_t> cut_off_above_us() const;

  /// Both cut-off pulses, ascending.
  [[nodiscard]] std::vector<std::int64_t> cut_off_us() const;

  /// The pulses worth listing, ascending: shortest (at least 0), neutral, longest, those of
  /// cut_off_us(), and those of autopilots (1000, 1500, 2000) that the servo accepts.
  [[nodiscard]] std::vector<std::int64_t> points_us() const;

  /// The pulses of autopilots that this servo ignores.
  [[nodiscard]] std::vector<std::int64_t> missed_us() const;

  friend bool operator==(const PwmMapping&, const PwmMapping&) = default;
};

/// Empty: one of 0x34-0x37 is unknown.
[[nodiscard]] std::optional<PwmMapping> pwm_mapping(const Values& values);

/// The registers of the mapping, its limits, the state of the input, and the fallback to PWM.
[[nodiscard]] const std::vector<Address>& pwm_registers();

/// The state of the PWM input (0x19).
enum class PwmInput : std::uint8_t { ok, none, too_short, too_long };

/// "ok", "none", "short", "long".
[[nodiscard]] std::string_view name(PwmInput input);

/// Empty: not known.
[[nodiscard]] std::optional<PwmInput> pwm_input(const Values& values);

/// The time without commands over CAN after which pulses are obeyed (4.30); empty: unknown.
[[nodiscard]] std::optional<std::int64_t> pwm_fallback_ms(const Values& values);

/// The specification's examples (4.30), 1 to 4, as values of 0x34-0x37.
[[nodiscard]] std::vector<std::string> pwm_preset(std::size_t number);
inline constexpr std::size_t pwm_presets = 4;

/// The mapping through two points: "500us:-70deg,1500us:70deg", as values of 0x34-0x37. Errors:
/// usage, with the nearest possible mapping.
[[nodiscard]] Result<std::vector<std::string>> pwm_from_endpoints(const Profiles& profiles,
                                                                  std::string_view text);

} // namespace blactl::bla
