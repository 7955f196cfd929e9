#pragma once
// Values common to several parts of a scenario file: times, unique IDs, node names.

#include "blactl/base/json_reader.hpp"
#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace blactl::sim {

/// The value as it would be typed on the command line. Empty, with an error, if it is neither a
/// number nor a string.
[[nodiscard]] std::optional<std::string> typed_text(const json::Value& value, json::Faults& faults);

/// By the value grammar, as if it were a register that counts microseconds; empty if the key is
/// left out. A fault beyond 0 to `longest`.
[[nodiscard]] std::optional<Duration> read_duration(json::Object& object, std::string_view key,
                                                    std::chrono::seconds longest,
                                                    json::Faults& faults);

/// "unique_id"; if missing, one derived from the number.
[[nodiscard]] dronecan::UniqueId read_unique_id(json::Object& object, std::uint64_t fallback,
                                                json::Faults& faults);

/// "name", as in GetNodeInfo.
[[nodiscard]] std::string read_node_name(json::Object& object, std::string fallback,
                                         json::Faults& faults);

} // namespace blactl::sim
