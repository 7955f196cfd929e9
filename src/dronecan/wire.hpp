#pragma once
// Reading and writing the fields of data types: little-endian bytes, no alignment. The few fields
// narrower than a byte fill it from the most significant bit (DroneCAN specification 3, "Data
// serialization"); their types shift them by hand.

#include "blactl/dronecan/types.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::dronecan {

/// A bool fills its byte from the most significant bit.
inline constexpr std::uint8_t true_bit = 0x80;

/// `value` in its low `bytes` bytes, least significant first.
inline void put_integer(Payload& payload, std::uint64_t value, std::size_t bytes) {
  for (; bytes > 0; --bytes, value >>= 8U) {
    payload.append(static_cast<std::uint8_t>(value));
  }
}

/// A two's complement integer, saturated to `bytes` bytes (1..8).
inline void put_signed(Payload& payload, std::int64_t value, std::size_t bytes) {
  const auto max = INT64_MAX >> (64 - 8 * bytes);
  put_integer(payload, std::bit_cast<std::uint64_t>(std::clamp(value, -max - 1, max)), bytes);
}

/// A DSDL field `float16`: saturated.
void put_float16(Payload& payload, float value);

inline void put_float32(Payload& payload, float value) {
  put_integer(payload, std::bit_cast<std::uint32_t>(value), sizeof(value));
}

/// The bytes of a string, at most `limit` of them.
inline void put_text(Payload& payload, std::string_view text, std::size_t limit) {
  for (const char c : text.substr(0, limit)) {
    payload.append(static_cast<std::uint8_t>(c));
  }
}

/// Takes fields from a payload. Beyond its end every field is 0 and ok() becomes false, so that a
/// decoder checks once, at its end.
class Reader {
 public:
  explicit Reader(Bytes payload) : rest_(payload) {}

  [[nodiscard]] bool ok() const { return ok_; }

  [[nodiscard]] Bytes rest() const { return rest_; }

  /// The next `size` bytes; none if there are fewer.
  Bytes take(std::size_t size) {
    if (size > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const auto bytes = rest_.first(size);
    rest_ = rest_.subspan(size);
    return bytes;
  }

  /// An unsigned integer of `bytes` bytes (0..8).
  std::uint64_t integer(std::size_t bytes) {
    std::uint64_t value = 0;
    unsigned shift = 0;
    for (const auto byte : take(bytes)) {
      value |= static_cast<std::uint64_t>(byte) << shift;
      shift += 8;
    }
    return value;
  }

  std::uint8_t u8() { return static_cast<std::uint8_t>(integer(1)); }

  std::uint16_t u16() { return static_cast<std::uint16_t>(integer(2)); }

  std::uint32_t u32() { return static_cast<std::uint32_t>(integer(4)); }

  std::uint64_t u64() { return integer(8); }

  /// A two's complement integer of `bytes` bytes (1..8).
  std::int64_t signed_integer(std::size_t bytes) {
    const auto unused = 64 - 8 * bytes;
    return std::bit_cast<std::int64_t>(integer(bytes) << unused) >> unused;
  }

  float float16() { return from_float16(u16()); }

  float float32() { return std::bit_cast<float>(u32()); }

  /// A string of any `size` bytes.
  std::string text(std::size_t size) {
    const auto bytes = take(size);
    return {bytes.begin(), bytes.end()};
  }

  /// The array at the end of a payload has no length of its own on classic CAN (tail array
  /// optimisation): returns the rest, which must not exceed `limit` bytes.
  std::string text_to_end(std::size_t limit) {
    ok_ = ok_ && rest_.size() <= limit;
    return ok_ ? text(rest_.size()) : std::string();
  }

 private:
  Bytes rest_;
  bool ok_ = true;
};

} // namespace blactl::dronecan
