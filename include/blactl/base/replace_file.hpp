#pragma once
// Files that are there as a whole or not at all.

#include "blactl/base/error.hpp"

#include <string>
#include <string_view>

namespace blactl {

/// Puts `content` in the place of the file `path`: written beside it, synced, renamed. What fails
/// leaves what was there. Errors: io.
[[nodiscard]] Result<void> replace_file(const std::string& path, std::string_view content);

/// Whether replace_file() can be expected to succeed: to be asked before what the file is to tell
/// of is done. Leaves nothing behind. Errors: io.
[[nodiscard]] Result<void> check_replaceable(const std::string& path);

} // namespace blactl
