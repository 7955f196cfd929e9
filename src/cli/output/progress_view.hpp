#pragma once
// The progress of a command in one line.

#include "blactl/fleet/change/carry_out.hpp"

#include <span>
#include <string>

namespace blactl::cli {

/// "11, 12, 13", limited to one line.
[[nodiscard]] std::string short_list(std::span<const dronecan::NodeId> ids);

[[nodiscard]] std::string text(const fleet::Progress& progress);

/// Whole seconds for people.
[[nodiscard]] long long whole_seconds(Duration duration);

} // namespace blactl::cli
