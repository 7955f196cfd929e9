#include "blactl/base/crc16.hpp"

#include <array>

namespace blactl {
namespace {

// The effect of eight shifts on each value of the CRC's upper byte (polynomial 0x1021).
constexpr auto table = [] {
  std::array<std::uint16_t, 256> values{};
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    auto crc = i << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 0x8000U) != 0 ? (crc << 1U) ^ 0x1021U : crc << 1U;
    }
    values[i] = static_cast<std::uint16_t>(crc);
  }
  return values;
}();

} // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc) {
  for (const auto byte : bytes) {
    crc = static_cast<std::uint16_t>((crc << 8U) ^ table[(crc >> 8U) ^ byte]);
  }
  return crc;
}

} // namespace blactl
