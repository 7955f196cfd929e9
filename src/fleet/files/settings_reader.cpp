#include "fleet/files/settings_reader.hpp"

#include "fleet/files/texts.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace blactl::fleet {

namespace {

/// A number as written in the file: its meaning is up to the grammar of values.
std::optional<std::string> value_text(const json::Value& value, json::Faults& faults) {
  switch (value.kind) {
  case json::Kind::integer: return std::to_string(value.integer);
  case json::Kind::real:
  case json::Kind::string: return value.text;
  default: faults.add(value, say<texts::fleet_value_kind>()); return std::nullopt;
  }
}

/// Empty: invalid, with an error.
std::optional<bla::Assignment> read_value(const json::Value& member, const bla::Profiles& profiles,
                                          json::Faults& faults) {
  const auto text = value_text(member, faults);
  if (!text) {
    return std::nullopt;
  }
  auto assignment = bla::make_assignment(profiles, member.key, *text);
  if (!assignment) {
    faults.add(member, fault_text(assignment.error()));
    return std::nullopt;
  }
  return std::move(*assignment);
}

} // namespace

std::vector<Setting> read_settings(std::span<const json::Value* const> members,
                                   const bla::Profiles& profiles, json::Faults& faults) {
  std::vector<Setting> settings;
  for (const json::Value* member : members) {
    auto assignment = read_value(*member, profiles, faults);
    if (!assignment) {
      continue;
    }
    const bla::Parameter* parameter = assignment->parameter;
    if (!parameter->is_setting()) {
      faults.add(*member, say<texts::fleet_no_setting>(parameter->name));
    } else if (find(settings, parameter->address) != nullptr) {
      faults.add(*member, say<texts::fleet_set_twice>(parameter->name));
    } else {
      settings.push_back({std::move(*assignment), member});
    }
  }
  return settings;
}

const Setting* find(std::span<const Setting> settings, bla::Address address) {
  const auto it = std::ranges::find_if(settings, [&](const Setting& setting) {
    return setting.assignment.parameter->address == address;
  });
  return it != settings.end() ? &*it : nullptr;
}

void check_model(std::span<const Setting> settings, std::span<const bla::Profile* const> models,
                 json::Faults& faults) {
  for (const Setting& setting : settings) {
    Result<void> allowed;
    for (const bla::Profile* model : models) {
      allowed = bla::allowed_by_model(*model, setting.assignment);
      if (allowed) {
        break;
      }
    }
    if (!allowed) {
      faults.add(*setting.where, fault_text(allowed.error()));
    }
  }
}

void check_pwm(std::span<const Setting> settings, const bla::Profiles& profiles,
               json::Faults& faults) {
  const Setting* range = find(settings, bla::address::pwm_output_range);
  const Setting* mode = find(settings, bla::address::pwm_mode);
  if (range == nullptr || mode == nullptr) {
    return;
  }
  if (const auto fits =
          bla::check_pwm_unit(profiles, range->assignment, mode->assignment.value.raw);
      !fits) {
    faults.add(*range->where, fault_text(fits.error()));
  }
}

bool check_id(const json::Value& where, std::string_view parameter, std::int64_t id,
              const bla::Profiles& profiles, json::Faults& faults) {
  const auto assignment = bla::make_assignment(profiles, parameter, std::to_string(id));
  if (!assignment) {
    faults.add(where, fault_text(assignment.error()));
    return false;
  }
  const bool is_none = assignment->parameter->address == bla::address::static_node_id && id == 0;
  if (is_none) {
    faults.add(where, say<texts::id_is_none>());
  }
  return !is_none;
}

} // namespace blactl::fleet
