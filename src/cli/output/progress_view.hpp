#pragma once
// How far a command is, in one line.

#include "blactl/fleet/change/carry_out.hpp"

#include <span>
#include <string>

namespace blactl::cli {

/// "11, 12, 13", and no more than one line takes.
[[nodiscard]] std::string short_list(std::span<const dronecan::NodeId> ids);

[[nodiscard]] std::string text(const fleet::Progress& progress);

/// Whole seconds, as a person counts them.
[[nodiscard]] long long whole_seconds(Duration duration);

} // namespace blactl::cli
