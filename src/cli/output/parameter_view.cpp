#include "cli/output/parameter_view.hpp"

#include "blactl/bla/explain.hpp"
#include "blactl/bla/value.hpp"

#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

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

/// In Japanese the specification's name stands beside the one that is typed.
bool shows_names() {
  return language() == Language::japanese;
}

std::string table_text(const ServoValues& servo, const bla::Profiles& profiles, const Page& page) {
  const auto values = servo.snapshot.values();
  const auto mode = servo.snapshot.pwm_mode();
  std::vector<std::string> header{"", say<texts::column_parameter>(), say<texts::column_value>(),
                                  say<texts::column_default>()};
  if (shows_names()) {
    header.push_back(say<texts::column_meaning>());
  }
  Table table(std::move(header));
  for (const Reading& reading : servo.shown) {
    const Parameter& parameter = *reading.parameter;
    std::vector<std::string> row{parameter.address.name(), parameter.name,
                                 bla::explained(parameter, *reading.raw, values),
                                 parameter.default_raw && parameter.writable()
                                     ? bla::display(parameter, *parameter.default_raw, mode)
                                     : ""};
    if (shows_names()) {
      row.push_back(parameter.name_ja);
    }
    table.add(std::move(row));
    for (std::string& line : bla::explained_bits(parameter, *reading.raw, profiles)) {
      table.add_below(std::move(line));
    }
  }
  return table.text("  ", page);
}

} // namespace

void write_json(JsonWriter& json, std::span<const ServoValues> servos) {
  json.key("nodes");
  json.begin_array();
  for (const ServoValues& servo : servos) {
    json.begin_object();
    write_head(json, servo.snapshot.servo);
    json.key("params");
    json.begin_array();
    for (const Reading& reading : servo.shown) {
      write_reading(json, servo, reading);
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
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

std::string text(std::span<const ServoValues> servos, const bla::Profiles& profiles,
                 bool changed_only, const Page& page) {
  std::string out;
  for (const ServoValues& servo : servos) {
    out += out.empty() ? "" : "\n";
    out += head_line(servo.snapshot.servo);
    if (servo.shown.empty()) {
      out += changed_only ? say<texts::nothing_changed>() : "";
      continue;
    }
    out += table_text(servo, profiles, page);
  }
  return out;
}

} // namespace blactl::cli
