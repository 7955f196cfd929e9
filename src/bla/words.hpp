#pragma once
// Words as people type and read them.

#include <string>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// ASCII letters in lower case.
[[nodiscard]] std::string lower(std::string_view text);

/// "a", "a or b", "a, b or c" in the language of the process.
[[nodiscard]] std::string either(const std::vector<std::string>& words);

} // namespace blactl::bla
