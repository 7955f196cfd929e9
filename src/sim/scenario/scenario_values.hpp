#pragma once
// Values common to several parts of a scenario file: times, unique IDs, node names.

#include "blactl/base/json_reader.hpp"
#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace blactl::sim {

/// The value as it would be typed on the command line. Empty, with an error, if it is neither a
/// number nor a string.
[[nodiscard]] std::optional<std::string> typed_text(const json::Value& value, json::Faults& faults);

/// Reads a value by the value grammar, like a register that counts microseconds; `fallback` if the
/// key is missing. Outside 0 to `longest` is an error.
[[nodiscard]] Duration read_duration(json::Object& object, std::string_view key, Duration fallback,
                                     std::chrono::seconds longest, json::Faults& faults);

/// From 0 to 1; 0 if the key is missing.
[[nodiscard]] double read_probability(json::Object& object, std::string_view key);

/// "unique_id"; if missing, one derived from the number.
[[nodiscard]] dronecan::UniqueId read_unique_id(json::Object& object, std::uint64_t fallback,
                                                json::Faults& faults);

/// "name", as in GetNodeInfo.
[[nodiscard]] std::string read_node_name(json::Object& object, std::string fallback,
                                         json::Faults& faults);

} // namespace blactl::sim
