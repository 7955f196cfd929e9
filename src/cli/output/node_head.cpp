#include "cli/output/node_head.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/value.hpp"

#include "cli/texts.hpp"

#include <optional>

namespace blactl::cli {
namespace {

std::optional<std::string> unique_id(const fleet::Member& member) {
  return member.info ? std::optional(hex(member.info->unique_id)) : std::nullopt;
}

std::optional<std::string> model(const fleet::Member& member) {
  const std::string name = member.identity.model();
  return name.empty() ? std::nullopt : std::optional(name);
}

std::string unknown() {
  return say<texts::unknown_word>();
}

} // namespace

std::string or_text(const std::optional<std::int64_t>& number, std::string_view none) {
  return number ? std::to_string(*number) : std::string(none);
}

void write_head(JsonWriter& json, const fleet::Member& member) {
  const bla::Readings& readings = member.identity.readings();
  json.member("node_id", member.id.value());
  json.member("unique_id", unique_id(member));
  json.member("model", model(member));
  json.member("serial_number", readings.serial_number);
  json.member("servo_id", member.is_servo ? member.servo_id : std::nullopt);
  json.member("firmware_version", readings.firmware_version);
  json.member("hardware_version", readings.hardware_version);
}

std::vector<std::string> head_columns() {
  return {"node_id",  "unique_id",        "model",           "serial_number",
          "servo_id", "firmware_version", "hardware_version"};
}

std::vector<std::string> head_cells(const fleet::Member& member) {
  const bla::Readings& readings = member.identity.readings();
  return {std::to_string(member.id.value()),
          unique_id(member).value_or(""),
          model(member).value_or(""),
          or_text(readings.serial_number, ""),
          or_text(member.is_servo ? member.servo_id : std::nullopt, ""),
          or_text(readings.firmware_version, ""),
          or_text(readings.hardware_version, "")};
}

std::string version_text(std::int64_t raw) {
  return raw < 0 ? std::to_string(raw) : fmt::format("{}.{:03}", raw / 1000, raw % 1000);
}

std::string register_text(const bla::Parameter& parameter, std::int64_t raw,
                          std::optional<std::int64_t> pwm_mode) {
  const std::string number = std::to_string(raw);
  std::string meaning = bla::display(parameter, raw, pwm_mode);
  const bool inactive = parameter.can_be_inactive && raw == bla::not_active;
  return inactive || meaning == number ? meaning : fmt::format("{}  ({})", number, meaning);
}

std::string head_line(const fleet::Member& member) {
  const bla::Readings& readings = member.identity.readings();
  return say<texts::head_line>(
      member.id.value(), model(member).value_or(unknown()),
      or_text(readings.serial_number, unknown()), or_text(member.servo_id, unknown()),
      readings.firmware_version ? version_text(*readings.firmware_version) : unknown());
}

} // namespace blactl::cli
