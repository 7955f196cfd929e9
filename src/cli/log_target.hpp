#pragma once
// Where logs, drawings and exports may be written.

#include "blactl/base/error.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::cli {

/// What a command writes into a file of its own. An empty file is any of them, the report of doctor
/// is a log.
enum class Content : std::uint8_t { log, drawing, events, facts };

/// Checks that it replaces nothing but its like, and takes the place of no file in which state is
/// kept; one that is written at once can be written. `option`: which names the file. Errors:
/// usage, io.
[[nodiscard]] Result<void> check_target(const std::string& file, Content content,
                                        std::string_view option);

/// Checks only that the file is none in which state is kept. Errors: usage.
[[nodiscard]] Result<void> check_no_state(const std::string& file, std::string_view option);

} // namespace blactl::cli
