#pragma once
// A CAN frame bit by bit, as a controller sends it (ISO 11898-1, classic frames).

#include "blactl/can/frame.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace blactl::can {

/// The stuffed part of a frame, start of frame to CRC. At 1 Mbit/s a bit takes 1 us.
class FrameBits {
 public:
  explicit FrameBits(const Frame& frame);

  /// The first bit in which two frames differ; size() of the shorter if none of its bits does.
  [[nodiscard]] std::size_t first_difference(const FrameBits& other) const;

  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  void push_field(std::uint32_t value, unsigned bits);
  void push(bool bit);
  void append(bool bit);

  /// 118 bits of the longest frame, and a stuff bit for every four of them.
  std::array<bool, 160> bits_{};
  std::size_t size_ = 0;
  unsigned run_ = 0; ///< equal bits at the end
  std::uint32_t crc_ = 0;
};

/// Bits between two frames.
inline constexpr std::size_t intermission_bits = 3;

/// The length of the frame: stuffed part, CRC delimiter, acknowledgement, end of frame. An extended
/// frame of 8 bytes has 128 to 157 bits here, without the intermission.
[[nodiscard]] std::size_t frame_length(const Frame& frame);
[[nodiscard]] std::size_t frame_length(const FrameBits& bits);

/// The bits that decide arbitration: identifier, RTR and IDE in bus order. The lower value wins.
[[nodiscard]] std::uint32_t arbitration_field(const Frame& frame);

} // namespace blactl::can
