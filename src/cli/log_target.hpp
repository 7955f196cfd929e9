#pragma once
// Where the log of a session may be written.

#include "blactl/base/error.hpp"

#include <string>
#include <string_view>

namespace blactl::cli {

/// Checks that a log replaces nothing but a log (an empty file is one, and so is the report of
/// doctor), and takes the place of no file in which state is kept. `option`: which names the file.
/// Errors: usage.
[[nodiscard]] Result<void> check_log_target(const std::string& file, std::string_view option);

} // namespace blactl::cli
