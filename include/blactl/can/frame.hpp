#pragma once
// One classic CAN frame.

#include <array>
#include <cstdint>
#include <span>

namespace blactl::can {

/// A data or remote frame as it crosses the bus. DroneCAN uses extended data frames only; the
/// others exist so that all traffic can be shown.
struct Frame {
  std::uint32_t id = 0; ///< 29 bits if extended, else 11; no flags.
  bool extended = true;
  bool remote = false;
  std::uint8_t size = 0; ///< 0..8
  std::array<std::uint8_t, 8> data{};

  [[nodiscard]] std::span<const std::uint8_t> payload() const { return {data.data(), size}; }

  friend bool operator==(const Frame&, const Frame&) = default;
};

inline constexpr std::uint32_t standard_id_mask = 0x7FF;
inline constexpr std::uint32_t extended_id_mask = 0x1FFF'FFFF;

} // namespace blactl::can
