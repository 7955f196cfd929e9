#pragma once
// The whole text of a file that a person names.

#include "blactl/base/error.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace blactl {

/// "-" reads stdin. Errors: bad_file with the system's reason, or that it is larger than `most`
/// bytes.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path, std::size_t most);

} // namespace blactl
