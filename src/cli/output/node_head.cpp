#include "cli/output/node_head.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/value.hpp"

#include "cli/texts.hpp"

#include <optional>

namespace blactl::cli {
namespace {

std::optional<std::string> unique_id(const fleet::Servo& servo) {
  return servo.unique_id ? std::optional(hex(*servo.unique_id)) : std::nullopt;
}

std::optional<std::string> model(const fleet::Servo& servo) {
  const std::string name = servo.identity.model();
  return name.empty() ? std::nullopt : std::optional(name);
}

bool has_node_id(const fleet::Servo& servo) {
  return servo.id.is_unicast() && servo.id_is_known;
}

std::string unknown() {
  return say<texts::unknown_word>();
}

} // namespace

std::string or_text(const std::optional<std::int64_t>& number, std::string_view none) {
  return number ? std::to_string(*number) : std::string(none);
}

void write_head(JsonWriter& json, const fleet::Servo& servo) {
  const bla::Readings& readings = servo.identity.readings();
  json.member("node_id", has_node_id(servo) ? std::optional(servo.id.value()) : std::nullopt);
  json.member("unique_id", unique_id(servo));
  json.member("model", model(servo));
  json.member("serial_number", readings.serial_number);
  json.member("servo_id", servo.is_servo ? servo.servo_id : std::nullopt);
  json.member("firmware_version", readings.firmware_version);
  json.member("hardware_version", readings.hardware_version);
}

std::vector<std::string> head_columns() {
  return {"node_id",  "unique_id",        "model",           "serial_number",
          "servo_id", "firmware_version", "hardware_version"};
}

std::vector<std::string> head_cells(const fleet::Servo& servo) {
  const bla::Readings& readings = servo.identity.readings();
  return {has_node_id(servo) ? std::to_string(servo.id.value()) : "",
          unique_id(servo).value_or(""),
          model(servo).value_or(""),
          or_text(readings.serial_number, ""),
          or_text(servo.is_servo ? servo.servo_id : std::nullopt, ""),
          or_text(readings.firmware_version, ""),
          or_text(readings.hardware_version, "")};
}

std::string version_text(std::int64_t raw) {
  return raw < 0 ? std::to_string(raw) : fmt::format("{}.{:03}", raw / 1000, raw % 1000);
}

std::string head_line(const fleet::Servo& servo) {
  const bla::Readings& readings = servo.identity.readings();
  return say<texts::head_line>(
      has_node_id(servo) ? std::to_string(servo.id.value()) : unknown(),
      model(servo).value_or(unknown()), or_text(readings.serial_number, unknown()),
      or_text(servo.servo_id, unknown()),
      readings.firmware_version ? version_text(*readings.firmware_version) : unknown());
}

} // namespace blactl::cli
