#pragma once
// How every output begins to speak of a node (contract, section 5).

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/roster.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// node_id, unique_id, model, serial_number, servo_id, firmware_version, hardware_version: the
/// first members of every node object; null where unknown or not a BLA servo.
void write_head(JsonWriter& json, const fleet::Member& member);

/// The same as CSV columns and cells; empty where JSON has null.
[[nodiscard]] std::vector<std::string> head_columns();
[[nodiscard]] std::vector<std::string> head_cells(const fleet::Member& member);

/// The line above a servo's data: "node 12  BLA21-12U-AB  serial 240900558 …".
[[nodiscard]] std::string head_line(const fleet::Member& member);

/// "1.400": 0x52 and 0x53 count thousandths.
[[nodiscard]] std::string version_text(std::int64_t raw);

/// A register and what it means: "900  (90.0 deg)"; one of them where both are the same.
[[nodiscard]] std::string register_text(const bla::Parameter& parameter, std::int64_t raw,
                                        std::optional<std::int64_t> pwm_mode);

/// A number, or what stands for none.
[[nodiscard]] std::string or_text(const std::optional<std::int64_t>& number, std::string_view none);

} // namespace blactl::cli
