#pragma once
// Files that are written completely or not at all.

#include "blactl/base/error.hpp"

#include <string>
#include <string_view>

namespace blactl {

/// Replaces the file `path` by `content`: written beside it, synced, renamed; it keeps its mode. On
/// failure, also where it is write-protected, the old file stays as it was. Errors: io.
[[nodiscard]] Result<void> replace_file(const std::string& path, std::string_view content);

/// Checks that replace_file() can be expected to succeed; called before the work that the file is
/// to record. Leaves nothing behind. Errors: io.
[[nodiscard]] Result<void> check_replaceable(const std::string& path);

} // namespace blactl
