#pragma once
// The identification of a node at the start of every output (contract, section 5).

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// node_id, unique_id, model, serial_number, servo_id, firmware_version, hardware_version: the
/// first members of every node object; null where unknown or not a BLA servo.
void write_head(JsonWriter& json, const fleet::Servo& servo);

/// The head as CSV columns and cells; empty where JSON has null.
[[nodiscard]] std::vector<std::string> head_columns();
[[nodiscard]] std::vector<std::string> head_cells(const fleet::Servo& servo);

/// The line above a servo's data: "node 12  BLA21-12U-AB  serial 240900558 …".
[[nodiscard]] std::string head_line(const fleet::Servo& servo);

/// "1.400": 0x52 and 0x53 count thousandths.
[[nodiscard]] std::string version_text(std::int64_t raw);

/// A number, or the placeholder for none.
[[nodiscard]] std::string or_text(const std::optional<std::int64_t>& number, std::string_view none);

} // namespace blactl::cli
