#pragma once
// Words of ASCII letters in either case. Bytes beyond ASCII stay as they are, whatever the locale.

#include <algorithm>
#include <string>
#include <string_view>

namespace blactl {

constexpr char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] inline std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) { return lower(c); });
  return out;
}

/// Whether both are the same but for the case of letters.
[[nodiscard]] constexpr bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char one, char other) { return lower(one) == lower(other); });
}

} // namespace blactl
