#include "can/mcast_datagram.hpp"

#include "blactl/base/crc16.hpp"

#include "can/kernel_frame.hpp"

#include <algorithm>

namespace blactl::can {
namespace {

constexpr std::uint16_t magic = 0x2934;
constexpr std::uint16_t flexible_rate = 1; ///< CAN FD

// Offsets of the fields.
constexpr std::size_t magic_at = 0;
constexpr std::size_t crc_at = 2;
constexpr std::size_t flags_at = 4; ///< the CRC covers the datagram from here on
constexpr std::size_t id_at = 6;

void put(std::span<std::uint8_t> field, std::uint32_t value) {
  for (std::size_t i = 0; i < field.size(); ++i) {
    field[i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

std::uint32_t take(std::span<const std::uint8_t> field) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    value |= static_cast<std::uint32_t>(field[i]) << (8 * i);
  }
  return value;
}

bool is_intact(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= Datagram::header_size && bytes.size() <= Datagram::max_size &&
         take(bytes.subspan(magic_at, 2)) == magic &&
         take(bytes.subspan(crc_at, 2)) == crc16(bytes.subspan(flags_at)) &&
         (take(bytes.subspan(flags_at, 2)) & flexible_rate) == 0;
}

} // namespace

// The message ID has its flags where the kernel has them: extended in bit 31, remote in bit 30,
// error in bit 29.

Datagram to_datagram(const Frame& frame) {
  const can_frame raw = to_kernel(frame);
  Datagram datagram;
  datagram.size = Datagram::header_size + raw.len;
  const std::span bytes = std::span(datagram.bytes).first(datagram.size);
  put(bytes.subspan(magic_at, 2), magic);
  put(bytes.subspan(id_at, 4), raw.can_id);
  if (!frame.remote) {
    std::ranges::copy_n(raw.data, raw.len, bytes.begin() + Datagram::header_size);
  }
  put(bytes.subspan(crc_at, 2), crc16(bytes.subspan(flags_at)));
  return datagram;
}

std::optional<Frame> from_datagram(std::span<const std::uint8_t> bytes) {
  if (!is_intact(bytes)) {
    return std::nullopt;
  }
  can_frame raw{};
  raw.can_id = take(bytes.subspan(id_at, 4));
  const auto data = bytes.subspan(Datagram::header_size);
  raw.len = static_cast<std::uint8_t>(data.size());
  std::ranges::copy(data, raw.data);
  const bool too_large =
      (raw.can_id & CAN_EFF_FLAG) == 0 && (raw.can_id & CAN_EFF_MASK) > CAN_SFF_MASK;
  if ((raw.can_id & CAN_ERR_FLAG) != 0 || too_large) {
    return std::nullopt;
  }
  return from_kernel(raw);
}

} // namespace blactl::can
