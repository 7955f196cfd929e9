#pragma once
// The tail byte, which ends every frame (DroneCAN specification 4.1, "Payload").

#include "blactl/dronecan/transfer.hpp"

#include <cstddef>
#include <cstdint>

namespace blactl::dronecan {

/// Payload bytes in a full frame of classic CAN; the eighth is the tail byte.
inline constexpr std::size_t frame_payload = 7;

/// Start in bit 7, end in bit 6, toggle in bit 5, transfer ID in bits 4..0.
struct Tail {
  bool start = false;
  bool end = false;
  bool toggle = false; ///< 0 in the first frame of a transfer, then alternating
  TransferId transfer_id = 0;

  [[nodiscard]] static constexpr Tail decode(std::uint8_t byte) {
    return {(byte & 0x80U) != 0, (byte & 0x40U) != 0, (byte & 0x20U) != 0,
            static_cast<TransferId>(byte & 0x1FU)};
  }

  [[nodiscard]] constexpr std::uint8_t encode() const {
    return static_cast<std::uint8_t>((start ? 0x80U : 0U) | (end ? 0x40U : 0U) |
                                     (toggle ? 0x20U : 0U) | (transfer_id & 0x1FU));
  }

  /// The only frame of its transfer.
  [[nodiscard]] constexpr bool single() const { return start && end; }
};

} // namespace blactl::dronecan
