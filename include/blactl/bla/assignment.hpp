#pragma once
// PARAM=VALUE as typed and as stored in files, with every check that needs no servo.

#include "blactl/base/error.hpp"
#include "blactl/bla/parameter.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/value.hpp"

#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// A value that some model accepts. Identity::may_write() checks it against the servo itself.
struct Assignment {
  const Parameter* parameter = nullptr; ///< one of Profiles::registers()
  NamedBy named = NamedBy::name;
  TypedValue value;
  std::string text; ///< as typed: "angle_limit_cw=90deg"
};

/// `parameter` is an address or a name, `value` follows the grammar of parse_value(). Errors:
/// unknown_parameter, usage, read_only, out_of_range (outside of the ranges of all models; 0x46 =
/// 126 or 127, which belong to tools), unsupported (reserved, 0x49, and 0x10-0x12, which have their
/// own commands).
[[nodiscard]] Result<Assignment>
make_assignment(const Profiles& profiles, std::string_view parameter, std::string_view value);

/// `text` is PARAM=VALUE. Errors: usage without "="; as make_assignment().
[[nodiscard]] Result<Assignment> parse_assignment(const Profiles& profiles, std::string_view text);

/// Errors: every fault, in the order typed: as parse_assignment(); usage for a parameter named
/// twice, and for 0x36 in a unit that contradicts the 0x37 beside it; cross_check for more than one
/// of 0x00-0x02.
[[nodiscard]] std::expected<std::vector<Assignment>, std::vector<Error>>
parse_assignments(const Profiles& profiles, std::span<const std::string> texts);

/// Checks that an assigned 0x36 has the unit set by `pwm_mode`, the 0x37 of the same command.
/// Errors: usage.
[[nodiscard]] Result<void> check_pwm_unit(const Profiles& profiles, const Assignment& assignment,
                                          std::int64_t pwm_mode);

/// The same check against the servo's present 0x37, which the command does not change.
[[nodiscard]] Result<void> check_pwm_unit_of_servo(const Profiles& profiles,
                                                   const Assignment& assignment,
                                                   std::int64_t pwm_mode);

/// Checks that some model accepts the value. Errors: out_of_range, with the range over all models.
[[nodiscard]] Result<void> allowed_by_some_model(const Profiles& profiles,
                                                 const Parameter& parameter,
                                                 const TypedValue& value);

/// Checks that this model accepts the value. Errors: unsupported (no PWM input, no such register),
/// out_of_range, naming the model and its range.
[[nodiscard]] Result<void> allowed_by_model(const Profile& model, const Assignment& assignment);

/// Checks for values that may never be sent to the register, whatever the model. Errors:
/// unsupported (0x49), read_only, out_of_range (0x46 = 126 or 127).
[[nodiscard]] Result<void> never_sent(const Parameter& parameter, std::int64_t raw);

/// The command that carries out one of 0x10-0x12.
[[nodiscard]] std::string_view operation_command(Address operation);

/// Why never_sent() refuses values within the range, for documentation; empty: it refuses none.
[[nodiscard]] std::string remark(const Parameter& parameter);

} // namespace blactl::bla
