#pragma once
// Reading the whole of a file named by the user.

#include "blactl/base/error.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace blactl {

/// "-" reads stdin. Errors: bad_file (the system's reason, or the file is larger than `most`
/// bytes).
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path, std::size_t most);

} // namespace blactl
