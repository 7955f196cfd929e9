#pragma once
// Digests of what was read, so that a record tells of which files and settings it speaks.

#include <string>
#include <string_view>

namespace blactl {

/// 64 lower-case hexadecimal digits (FIPS 180-4).
[[nodiscard]] std::string sha256(std::string_view bytes);

} // namespace blactl
