#pragma once
// How far a command is, in one line.

#include "blactl/fleet/carry_out.hpp"

#include <string>

namespace blactl::cli {

[[nodiscard]] std::string text(const fleet::Progress& progress);

/// Whole seconds, as a person counts them.
[[nodiscard]] long long whole_seconds(Duration duration);

} // namespace blactl::cli
