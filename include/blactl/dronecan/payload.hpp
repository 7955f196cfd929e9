#pragma once
// A small byte buffer for payloads of the data types that blactl sends.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace blactl::dronecan {

/// Up to 384 bytes in place: the longest type sent here (GetNodeInfo response) has 376.
class Payload {
 public:
  static constexpr std::size_t capacity = 384;

  Payload() = default;

  explicit Payload(std::span<const std::uint8_t> bytes) { append(bytes); }

  /// Drops bytes beyond the capacity; the encoders stay below it by their types.
  void append(std::span<const std::uint8_t> bytes) {
    const auto n = std::min(bytes.size(), capacity - size_);
    std::copy_n(bytes.begin(), n, bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += n;
  }

  void append(std::uint8_t byte) { append(std::span(&byte, 1)); }

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return {bytes_.data(), size_}; }

 private:
  std::array<std::uint8_t, capacity> bytes_{};
  std::size_t size_ = 0;
};

} // namespace blactl::dronecan
