#include "cli/output/parameter_view.hpp"

#include "blactl/bla/explain.hpp"
#include "blactl/bla/value.hpp"

#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace blactl::cli {

using bla::Parameter;
using fleet::Reading;

namespace {

bool is_inactive(const Parameter& parameter, std::int64_t raw) {
  return parameter.can_be_inactive && raw == bla::not_active;
}

/// The number in the parameter's unit; empty for "not active".
std::optional<std::string> number(const ServoValues& servo, const Reading& reading) {
  if (is_inactive(*reading.parameter, *reading.raw)) {
    return std::nullopt;
  }
  return bla::value_text(*reading.parameter, *reading.raw, servo.snapshot.pwm_mode());
}

void write_reading(JsonWriter& json, const ServoValues& servo, const Reading& reading) {
  const Parameter& parameter = *reading.parameter;
  const auto mode = servo.snapshot.pwm_mode();
  json.begin_object();
  json.member("address", parameter.address.name());
  json.member("name", parameter.name);
  json.member("raw", *reading.raw);
  json.key("value");
  const auto value = number(servo, reading);
  value ? json.number(*value) : json.value(nullptr);
  json.member("unit", bla::unit_text(parameter, mode));
  json.member("text", bla::display(parameter, *reading.raw, mode));
  json.member("default", parameter.default_raw);
  json.member("min", parameter.min);
  json.member("max", parameter.max);
  json.member("access", bla::name(parameter.access));
  json.end_object();
}

/// In Japanese the specification's name is shown beside the typed one.
bool shows_names() {
  return language() == Language::japanese;
}

Table table(const ServoValues& servo, const bla::Profiles& profiles, bool with_defaults) {
  const auto values = servo.snapshot.values();
  const auto mode = servo.snapshot.pwm_mode();
  const auto row_of = [&](std::string address, std::string name, std::string value,
                          std::string initial, std::string_view title) {
    std::vector row{std::move(address), std::move(name), std::move(value)};
    if (with_defaults) {
      row.push_back(std::move(initial));
    }
    if (shows_names()) {
      row.emplace_back(title);
    }
    return row;
  };
  Table table(row_of("", say<texts::column_parameter>(), say<texts::column_value>(),
                     say<texts::column_default>(), say<texts::column_meaning>()));
  for (const Reading& reading : servo.shown) {
    const Parameter& parameter = *reading.parameter;
    table.add(row_of(parameter.address.name(), parameter.name,
                     bla::register_text(parameter, *reading.raw, mode),
                     parameter.writable() ? bla::default_text(parameter) : "", parameter.name_ja));
    for (std::string& line : bla::explained(parameter, *reading.raw, values, profiles)) {
      table.add_below(std::move(line));
    }
  }
  return table;
}

constexpr std::string_view indent = "  ";

bool has_default(const ServoValues& servo) {
  return std::ranges::any_of(servo.shown, [](const Reading& reading) {
    return reading.parameter->writable() && reading.parameter->default_raw;
  });
}

/// If a page is too narrow for both, names take precedence over defaults; a value that differs from
/// its default shows the default beside it. Servos shown together have the same columns.
bool has_room_for_defaults(std::span<const ServoValues> servos, const bla::Profiles& profiles,
                           const Page& page) {
  return std::ranges::all_of(servos, [&](const ServoValues& servo) {
    return !has_default(servo) || table(servo, profiles, true).fits(indent, page);
  });
}

} // namespace

void write_json(JsonWriter& json, std::span<const ServoValues> servos) {
  json.objects("nodes", servos, [&](const ServoValues& servo) {
    write_head(json, servo.snapshot.servo);
    json.array("params", servo.shown,
               [&](const Reading& reading) { write_reading(json, servo, reading); });
  });
}

std::string csv(std::span<const ServoValues> servos) {
  auto columns = head_columns();
  for (const char* name :
       {"address", "name", "raw", "value", "unit", "text", "default", "min", "max", "access"}) {
    columns.emplace_back(name);
  }
  std::string out = csv_line(columns);
  for (const ServoValues& servo : servos) {
    const auto mode = servo.snapshot.pwm_mode();
    for (const Reading& reading : servo.shown) {
      const Parameter& parameter = *reading.parameter;
      auto cells = head_cells(servo.snapshot.servo);
      for (std::string cell :
           {parameter.address.name(), parameter.name, std::to_string(*reading.raw),
            number(servo, reading).value_or(""), std::string(bla::unit_text(parameter, mode)),
            bla::display(parameter, *reading.raw, mode), or_text(parameter.default_raw, ""),
            or_text(parameter.min, ""), or_text(parameter.max, ""),
            std::string(bla::name(parameter.access))}) {
        cells.push_back(std::move(cell));
      }
      out += csv_line(cells);
    }
  }
  return out;
}

namespace {

std::string without_values(const ServoValues& servo, bool changed_only) {
  if (changed_only && servo.can_differ) {
    return servo.is_complete ? say<texts::nothing_changed>() : say<texts::nothing_read_changed>();
  }
  if (changed_only && servo.is_complete) {
    return say<texts::nothing_with_default>();
  }
  return servo.snapshot.errors().empty() ? say<texts::nothing_readable>() : std::string();
}

} // namespace

std::string text(std::span<const ServoValues> servos, const bla::Profiles& profiles,
                 bool changed_only, const Page& page) {
  const bool with_defaults =
      changed_only || !shows_names() || has_room_for_defaults(servos, profiles, page);
  std::string out;
  for (const ServoValues& servo : servos) {
    out += out.empty() ? "" : "\n";
    out += head_line(servo.snapshot.servo);
    if (servo.shown.empty()) {
      out += without_values(servo, changed_only);
      continue;
    }
    out += table(servo, profiles, with_defaults && has_default(servo)).text(indent, page);
  }
  return out;
}

} // namespace blactl::cli
