#pragma once
// Conversion of values between text and register, exact both ways (contract, sections 4 and 7).

#include "blactl/base/error.hpp"
#include "blactl/bla/parameter.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::bla {

/// How a parameter was named: a bare integer is a register number by address, in units by name.
enum class NamedBy : std::uint8_t { address, name };

/// A value as it was typed.
struct TypedValue {
  std::int64_t raw = 0;
  /// 0x36 in deg or rpm is right only if 0x37 has this value.
  std::optional<std::int64_t> pwm_mode;
};

/// Reads `text` as a value of `parameter`: `[-]digits[.digits]unit`, `[-]digits`, `[-]digits` raw,
/// or a word of the enumeration. The range is not checked here. Errors, with a hint what to type:
/// usage (not a number, wrong or missing unit, finer than the register, unknown word); out_of_range
/// (no such enumeration value, beyond 64 bits).
[[nodiscard]] Result<TypedValue> parse_value(const Parameter& parameter, NamedBy named,
                                             std::string_view text);

/// "for example angle_limit_cw=179.9deg", in the language of the session: a value that every model
/// accepts, or one with the model that accepts it.
[[nodiscard]] std::string example_text(const Parameter& parameter);

/// Checks that `raw` lies in the parameter's range. Errors: out_of_range, naming the range in
/// units; `pwm_mode` decides for 0x36.
[[nodiscard]] Result<void> check_range(const Parameter& parameter, std::int64_t raw,
                                       std::optional<std::int64_t> pwm_mode = std::nullopt);

/// The number in the parameter's unit as a decimal text: "90.0", "1520". Exact. `pwm_mode` decides
/// for 0x36; without it register numbers are shown. Empty for "not active" in 0x00-0x02.
[[nodiscard]] std::string value_text(const Parameter& parameter, std::int64_t raw,
                                     std::optional<std::int64_t> pwm_mode = std::nullopt);

/// The unit that goes with value_text(): "deg"; "" for none.
[[nodiscard]] std::string_view unit_text(const Parameter& parameter,
                                         std::optional<std::int64_t> pwm_mode = std::nullopt);

/// The text, by name, that parses to exactly this value of a writable register: "90.0deg", "brake",
/// "1520us", "40"; for 0x36 without `pwm_mode` "700raw".
[[nodiscard]] std::string input_text(const Parameter& parameter, std::int64_t raw,
                                     std::optional<std::int64_t> pwm_mode = std::nullopt);

/// The default for people, in the unit that follows from the default of 0x37; empty: none.
[[nodiscard]] std::string default_text(const Parameter& parameter);

/// For people: "90.0 deg", "brake", "1.400", "not active" (in the language of the session).
[[nodiscard]] std::string display(const Parameter& parameter, std::int64_t raw,
                                  std::optional<std::int64_t> pwm_mode = std::nullopt);

/// A register number and its meaning: "900  (90.0 deg)"; one of them where both are the same.
[[nodiscard]] std::string register_text(const Parameter& parameter, std::int64_t raw,
                                        std::optional<std::int64_t> pwm_mode = std::nullopt);

/// The values of 0x37: pulses command an angle, or a speed.
inline constexpr std::int64_t pwm_angle_mode = 0, pwm_speed_mode = 1;

/// Whether 0x37 determines the unit, as for 0x36: without `pwm_mode` such a value is meaningless.
[[nodiscard]] bool unit_depends_on_mode(const Parameter& parameter);

} // namespace blactl::bla
