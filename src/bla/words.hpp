#pragma once
// Words as people type and read them.

#include <string>
#include <vector>

namespace blactl::bla {

/// "a", "a or b", "a, b or c" in the language of the process.
[[nodiscard]] std::string either(const std::vector<std::string>& words);

} // namespace blactl::bla
