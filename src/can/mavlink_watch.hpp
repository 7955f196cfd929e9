#pragma once
// Whether a stream of bytes is MAVLink.

#include <cstddef>
#include <cstdint>

namespace blactl::can {

/// Two frames, version 1 or 2, that follow each other without a gap: where the length of the first
/// one says, the next one begins. Nothing is decoded. Source: mavlink.io, "Packet Serialization".
///
///   0xFE length  sequence system component message(1)  payload  CRC(2)
///   0xFD length  flags flags sequence system component message(3)  payload  CRC(2) [signature(13)]
class MavlinkWatch {
 public:
  void take(std::uint8_t byte);

  [[nodiscard]] bool has_heard() const { return has_heard_; }

 private:
  enum class Awaits : std::uint8_t { begin, length, flags, end };

  void begin(std::uint8_t byte);

  Awaits awaits_ = Awaits::begin;
  std::uint8_t begin_ = 0; ///< the byte that this frame began with
  std::size_t left_ = 0;   ///< bytes to the end of this frame
  bool follows_ = false;   ///< a frame has just ended
  bool has_heard_ = false;
};

} // namespace blactl::can
