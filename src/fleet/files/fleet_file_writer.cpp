// Writes fleet files and recipes from settings of servos.

#include "blactl/base/hex.hpp"
#include "blactl/base/json_writer.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/bla/explain.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/recipe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

namespace blactl::fleet {
namespace {

/// The name of a servo, as on its label.
std::string name_of(const Servo& servo) {
  const auto serial = servo.identity.readings().serial_number;
  return fmt::format("{}-{}", servo.identity.model(), serial ? std::to_string(*serial) : "unknown");
}

/// Serial numbers may be doubled: no two entries have the same name.
std::string unused_name(const Servo& servo, std::set<std::string>& used) {
  const std::string name = name_of(servo);
  std::string unused = name;
  for (int number = 2; !used.insert(unused).second; ++number) {
    unused = fmt::format("{}-{}", name, number);
  }
  return unused;
}

void write_match(JsonWriter& json, const Servo& servo) {
  json.key("match");
  json.begin_object();
  if (servo.unique_id) {
    json.member("unique_id", hex(*servo.unique_id));
  }
  if (const auto serial = servo.identity.readings().serial_number) {
    json.member("serial_number", *serial);
  }
  if (!servo.unique_id) { // may be missing in a recording
    json.member("model", servo.identity.model());
  }
  json.end_object();
}

/// Writes a value that the file's grammar reads as exactly this raw value.
void write_value(JsonWriter& json, const bla::Parameter& parameter, std::int64_t raw,
                 std::optional<std::int64_t> pwm_mode) {
  const std::string text = bla::input_text(parameter, raw, pwm_mode);
  json.key(parameter.name);
  const bool is_number = text.find_first_not_of("-0123456789") == std::string::npos;
  is_number ? json.number(text) : json.value(text);
}

void write_set(JsonWriter& json, const Snapshot& servo, bool with_ids) {
  json.key("set");
  json.begin_object();
  for (const Reading& reading : servo.readings) {
    const bla::Address address = reading.parameter->address;
    if (reading.parameter->is_setting() && reading.raw && (with_ids || !bla::is_id(address))) {
      write_value(json, *reading.parameter, *reading.raw, servo.pwm_mode());
    }
  }
  json.end_object();
}

void write_about(JsonWriter& json, const Snapshot& servo, const FleetFileStyle& style) {
  const bla::Readings& readings = servo.servo.identity.readings();
  json.key("about");
  json.begin_object();
  json.member("model", servo.servo.identity.model());
  if (readings.firmware_version) {
    json.member("firmware_version", *readings.firmware_version);
  }
  if (readings.hardware_version) {
    json.member("hardware_version", *readings.hardware_version);
  }
  if (const auto date = bla::production_time(servo.values())) {
    json.member("production_date", *date);
  }
  if (style.time) {
    json.member("time", rfc3339(*style.time));
  }
  json.member("tool_version", style.tool_version);
  json.end_object();
}

} // namespace

std::vector<const bla::Parameter*> registers_to_export(const Servo& servo) {
  std::vector<const bla::Parameter*> registers = servo.identity.configuration();
  std::erase_if(registers, [&](const bla::Parameter* each) { // no value of it could be written
    return !servo.identity.check_takes(*each);
  });
  constexpr std::array production{bla::address::production_year, bla::address::production_month,
                                  bla::address::production_day, bla::address::production_hour,
                                  bla::address::production_minute};
  std::ranges::copy(servo.identity.registers(production), std::back_inserter(registers));
  if (const bla::Parameter* state =
          rom_state(servo.identity)) { // whether the values are those of ROM
    registers.push_back(state);
  }
  return registers;
}

void drop_unrecorded_state(Snapshot& snapshot) {
  const bla::Parameter* state = rom_state(snapshot.servo.identity);
  std::erase_if(snapshot.readings, [&](const Reading& reading) {
    return reading.parameter == state && !reading.raw &&
           reading.raw.error().code == Code::not_recorded;
  });
}

std::string fleet_file(std::span<const Snapshot> servos, const FleetFileStyle& style) {
  std::string text;
  JsonWriter json(text, JsonWriter::Layout::pretty);
  json.begin_object();
  json.member("schema", fleet_schema);
  json.key("servos");
  json.begin_array();
  std::set<std::string> used;
  for (const Snapshot& servo : servos) {
    json.begin_object();
    json.member("name", unused_name(servo.servo, used));
    write_match(json, servo.servo);
    write_set(json, servo, true);
    write_about(json, servo, style);
    json.end_object();
  }
  json.end_array();
  json.end_object();
  return text + '\n';
}

std::string recipe_file(const Snapshot& servo) {
  std::string text;
  JsonWriter json(text, JsonWriter::Layout::pretty);
  json.begin_object();
  json.member("schema", recipe_schema);
  json.member("name", servo.servo.identity.model());
  json.member("model", servo.servo.identity.model());
  json.member("firmware_min", servo.servo.identity.readings().firmware_version);
  write_set(json, servo, false);
  json.end_object();
  return text + '\n';
}

} // namespace blactl::fleet
