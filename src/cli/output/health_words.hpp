#pragma once
// The words of the contract, section 5, for what a node says of itself.

#include "blactl/dronecan/types.hpp"

#include <string_view>

namespace blactl::cli {

/// ok, warning, error, critical.
[[nodiscard]] std::string_view name(dronecan::Health health);

/// operational, initialization, maintenance, software_update, offline; empty for the values that
/// the standard reserves.
[[nodiscard]] std::string_view name(dronecan::Mode mode);

} // namespace blactl::cli
