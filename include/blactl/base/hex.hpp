#pragma once
// Bytes as hexadecimal digits.

#include <cstdint>
#include <span>
#include <string>

namespace blactl {

/// Two lower-case digits a byte: unique IDs and payloads in every output.
[[nodiscard]] inline std::string hex(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out;
  out.reserve(bytes.size() * 2);
  for (const std::uint8_t byte : bytes) {
    out += digits[byte >> 4];
    out += digits[byte & 0xF];
  }
  return out;
}

} // namespace blactl
