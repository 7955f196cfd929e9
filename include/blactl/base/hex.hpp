#pragma once
// Bytes as hexadecimal digits.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace blactl {

/// Appends two lower-case digits a byte: unique IDs and payloads in every output.
inline void append_hex(std::string& out, std::span<const std::uint8_t> bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  auto at = out.size();
  out.resize(at + bytes.size() * 2);
  for (const std::uint8_t byte : bytes) {
    out[at++] = digits[byte >> 4];
    out[at++] = digits[byte & 0xF];
  }
}

[[nodiscard]] inline std::string hex(std::span<const std::uint8_t> bytes) {
  std::string out;
  append_hex(out, bytes);
  return out;
}

} // namespace blactl
