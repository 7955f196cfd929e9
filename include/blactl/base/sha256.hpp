#pragma once
// Digests of input, so that a record identifies the files and settings it was made from.

#include <string>
#include <string_view>

namespace blactl {

/// 64 lower-case hexadecimal digits (FIPS 180-4).
[[nodiscard]] std::string sha256(std::string_view bytes);

} // namespace blactl
