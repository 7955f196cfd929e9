#pragma once
// The CRC of DroneCAN transfers and of CAN frames in multicast datagrams.

#include <cstdint>
#include <span>

namespace blactl {

/// CRC-16/CCITT-FALSE (poly 0x1021, init 0xFFFF, no reflection) over `bytes`, continued from `crc`.
/// Over "123456789" it is 0x29B1.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc = 0xFFFF);

} // namespace blactl
