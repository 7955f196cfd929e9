#pragma once
// One CAN frame as a datagram of DroneCAN over UDP multicast (specification 4.2): magic, CRC, flags
// and message ID, little-endian, then the data, whose length is that of the datagram.

#include "blactl/can/frame.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace blactl::can {

struct Datagram {
  /// 10 bytes before at most 8 of data.
  static constexpr std::size_t header_size = 10;
  static constexpr std::size_t max_size = header_size + 8;

  std::array<std::uint8_t, max_size> bytes{};
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::uint8_t> view() const { return std::span(bytes).first(size); }
};

/// A remote frame carries as many zeros as its length code says: the format has no other field for
/// it.
[[nodiscard]] Datagram to_datagram(const Frame& frame);

/// Empty unless it holds a frame of classic CAN: a wrong magic, length or CRC, CAN FD, an error
/// frame, an ID too large for its kind. Flags without a meaning are ignored.
[[nodiscard]] std::optional<Frame> from_datagram(std::span<const std::uint8_t> bytes);

} // namespace blactl::can
