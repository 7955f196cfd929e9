#pragma once
// Settings as files hold them: {"angle_limit_cw": "45.0deg", "0x2A": 120}.

#include "blactl/base/json_reader.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// A value and where it stands.
struct Setting {
  bla::Assignment assignment;
  const json::Value* where = nullptr;
};

/// Those of `members`, in their order. Faults: what is no value, what no model takes, registers
/// that are no settings, one that is there twice.
[[nodiscard]] std::vector<Setting> read_settings(std::span<const json::Value* const> members,
                                                 const bla::Profiles& profiles,
                                                 json::Faults& faults);

/// Null: it is not among them.
[[nodiscard]] const Setting* find(std::span<const Setting> settings, bla::Address address);

/// Faults: what none of these models takes.
void check_model(std::span<const Setting> settings, std::span<const bla::Profile* const> models,
                 json::Faults& faults);

/// Faults: 0x36 in a unit that the 0x37 beside it does not take.
void check_pwm(std::span<const Setting> settings, const bla::Profiles& profiles,
               json::Faults& faults);

/// Whether some servo takes this ID: servo_id (0x45), or static_node_id (0x46) but for 0, with
/// which it would ask for one. Else that is a fault.
[[nodiscard]] bool check_id(const json::Value& where, std::string_view parameter, std::int64_t id,
                            const bla::Profiles& profiles, json::Faults& faults);

} // namespace blactl::fleet
