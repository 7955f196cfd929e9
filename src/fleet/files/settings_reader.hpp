#pragma once
// Settings in files: {"angle_limit_cw": "45.0deg", "0x2A": 120}.

#include "blactl/base/error.hpp"
#include "blactl/base/json_reader.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// A refusal as one of the errors of a file: "angle_limit_cw=90: 90 or 9.0 degrees? (for example
/// angle_limit_cw=90.0deg)".
[[nodiscard]] inline std::string fault_text(const Error& error) {
  return error.hint.empty() ? error.message : error.message + " (" + error.hint + ')';
}

/// A value and its place in the file.
struct Setting {
  bla::Assignment assignment;
  const json::Value* where = nullptr;
};

/// The settings in `members`, in their order. Errors: invalid values, values that no model accepts,
/// registers that are not settings, repeated ones.
[[nodiscard]] std::vector<Setting> read_settings(std::span<const json::Value* const> members,
                                                 const bla::Profiles& profiles,
                                                 json::Faults& faults);

/// Null: it is not among them.
[[nodiscard]] const Setting* find(std::span<const Setting> settings, bla::Address address);

/// Adds errors for values that none of these models accepts.
void check_model(std::span<const Setting> settings, std::span<const bla::Profile* const> models,
                 json::Faults& faults);

/// Adds errors for 0x36 in a unit that contradicts the 0x37 beside it.
void check_pwm(std::span<const Setting> settings, const bla::Profiles& profiles,
               json::Faults& faults);

/// Whether some servo accepts this ID: servo_id (0x45), or static_node_id (0x46) except 0, with
/// which it would ask for one. Otherwise adds an error.
[[nodiscard]] bool check_id(const json::Value& where, std::string_view parameter, std::int64_t id,
                            const bla::Profiles& profiles, json::Faults& faults);

} // namespace blactl::fleet
