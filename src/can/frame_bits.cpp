#include "blactl/can/frame_bits.hpp"

#include <algorithm>

namespace blactl::can {
namespace {

constexpr unsigned crc_bits = 15;
constexpr std::uint32_t crc_polynomial = 0x4599; // CRC-15-CAN
constexpr std::uint32_t crc_mask = 0x7FFF;
constexpr unsigned stuff_after = 5;

/// CRC delimiter, acknowledgement slot and delimiter, seven bits end of frame: never stuffed.
constexpr std::size_t trailer_bits = 1 + 2 + 7;

constexpr unsigned low_id_bits = 18; // of an extended identifier

} // namespace

FrameBits::FrameBits(const Frame& frame) {
  push(false); // start of frame
  if (frame.extended) {
    push_field(frame.id >> low_id_bits, 11);
    push_field(3, 2); // SRR, IDE
    push_field(frame.id, low_id_bits);
    push(frame.remote);
    push_field(0, 2); // r1, r0
  } else {
    push_field(frame.id, 11);
    push(frame.remote);
    push_field(0, 2); // IDE, r0
  }
  push_field(frame.size, 4);
  if (!frame.remote) {
    for (const std::uint8_t byte : frame.payload()) {
      push_field(byte, 8);
    }
  }
  const std::uint32_t crc = crc_; // further bits change crc_, but no longer matter
  push_field(crc, crc_bits);
}

void FrameBits::push_field(std::uint32_t value, unsigned bits) {
  for (unsigned i = bits; i-- > 0;) {
    push(((value >> i) & 1U) != 0);
  }
}

void FrameBits::push(bool bit) {
  const bool divide = bit != ((crc_ >> (crc_bits - 1)) & 1U);
  crc_ = ((crc_ << 1U) ^ (divide ? crc_polynomial : 0)) & crc_mask;
  append(bit);
  if (run_ == stuff_after) {
    append(!bit);
  }
}

void FrameBits::append(bool bit) {
  run_ = size_ > 0 && bits_[size_ - 1] == bit ? run_ + 1 : 1;
  bits_[size_++] = bit;
}

std::size_t FrameBits::first_difference(const FrameBits& other) const {
  const auto end = bits_.begin() + static_cast<std::ptrdiff_t>(std::min(size_, other.size_));
  return static_cast<std::size_t>(std::mismatch(bits_.begin(), end, other.bits_.begin()).first -
                                  bits_.begin());
}

std::size_t frame_length(const Frame& frame) {
  return frame_length(FrameBits(frame));
}

std::size_t frame_length(const FrameBits& bits) {
  return bits.size() + trailer_bits;
}

std::uint32_t arbitration_field(const Frame& frame) {
  const std::uint32_t remote = frame.remote ? 1U : 0U;
  if (!frame.extended) {
    return (frame.id << 21U) | (remote << 20U);
  }
  const std::uint32_t low = frame.id & ((1U << low_id_bits) - 1);
  return ((frame.id >> low_id_bits) << 21U) | (3U << 19U) | (low << 1U) | remote;
}

} // namespace blactl::can
