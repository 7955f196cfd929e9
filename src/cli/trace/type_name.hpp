#pragma once
// Names of data types as shown and typed.

#include "blactl/dronecan/types.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::cli {

/// The end of the type's name, as short as it is unique: "NodeStatus", "actuator.Status",
/// "esc.Status".
[[nodiscard]] std::string_view short_name(const dronecan::DataType& type);

/// "NodeStatus", "GetSet.Request"; "20001" if the type is unknown.
[[nodiscard]] std::string type_text(dronecan::Kind kind, std::uint16_t data_type_id);

/// Whether `typed` is the whole name or its last parts, in upper or lower case:
/// "uavcan.protocol.param.GetSet", "param.getset", "GetSet".
[[nodiscard]] bool means(std::string_view typed, std::string_view name);

} // namespace blactl::cli
