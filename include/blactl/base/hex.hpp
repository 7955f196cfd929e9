#pragma once
// Bytes as hexadecimal digits.

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace blactl {

/// Appends two lower-case digits per byte: unique IDs and payloads in every output.
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

/// The bytes encoded by exactly 2 * `size` digits of either case; null: `digits` are not that.
template <std::size_t size>
[[nodiscard]] std::optional<std::array<std::uint8_t, size>> from_hex(std::string_view digits) {
  std::array<std::uint8_t, size> bytes{};
  if (digits.size() != size * 2) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < size; ++i) {
    const std::string two(digits.substr(i * 2, 2));
    const auto [end, error] = std::from_chars(two.data(), two.data() + two.size(), bytes[i], 16);
    if (error != std::errc() || end != two.data() + two.size()) {
      return std::nullopt;
    }
  }
  return bytes;
}

} // namespace blactl
