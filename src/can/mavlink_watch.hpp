#pragma once
// Recognises a stream of bytes as MAVLink.

#include <cstddef>
#include <cstdint>

namespace blactl::can {

/// Two frames, version 1 or 2, without a gap between them: the next begins where the length of the
/// first one says. Nothing is decoded. Source: mavlink.io, "Packet Serialization".
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
  std::uint8_t begin_ = 0; ///< the first byte of this frame
  std::size_t left_ = 0;   ///< bytes to the end of this frame
  bool follows_ = false;   ///< a frame has just ended
  bool has_heard_ = false;
};

} // namespace blactl::can
