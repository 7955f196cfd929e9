#pragma once
// Where logs, drawings and exports may be written.

#include "blactl/base/error.hpp"

#include <string>
#include <string_view>

namespace blactl::cli {

/// Checks that a log replaces nothing but a log (an empty file is one, and so is the report of
/// doctor), and takes the place of no file in which state is kept. `option`: which names the file.
/// Errors: usage.
[[nodiscard]] Result<void> check_log_target(const std::string& file, std::string_view option);

/// Likewise for a drawing, which replaces nothing but a drawing. Errors also: io (it cannot be
/// written).
[[nodiscard]] Result<void> check_drawing_target(const std::string& file, std::string_view option);

/// Checks only that the file is none in which state is kept. Errors: usage.
[[nodiscard]] Result<void> check_no_state(const std::string& file, std::string_view option);

} // namespace blactl::cli
