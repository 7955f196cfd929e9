#include "can/mavlink_watch.hpp"

namespace blactl::can {
namespace {

constexpr std::uint8_t version_1 = 0xFE, version_2 = 0xFD;

// Bytes after the length and, in version 2, the first flags; without the payload.
constexpr std::size_t rest_1 = 6, rest_2 = 9, signature = 13;
constexpr std::uint8_t is_signed = 1;

} // namespace

void MavlinkWatch::take(std::uint8_t byte) {
  switch (awaits_) {
  case Awaits::begin: begin(byte); break;
  case Awaits::length:
    left_ = byte + (begin_ == version_1 ? rest_1 : rest_2);
    awaits_ = begin_ == version_1 ? Awaits::end : Awaits::flags;
    break;
  case Awaits::flags:
    left_ += (byte & is_signed) != 0 ? signature : 0;
    awaits_ = Awaits::end;
    break;
  case Awaits::end:
    if (--left_ == 0) {
      follows_ = true;
      awaits_ = Awaits::begin;
    }
    break;
  }
}

void MavlinkWatch::begin(std::uint8_t byte) {
  const bool begins = byte == version_1 || byte == version_2;
  has_heard_ = has_heard_ || (begins && follows_ && byte == begin_);
  follows_ = false;
  if (begins) {
    begin_ = byte;
    awaits_ = Awaits::length;
  }
}

} // namespace blactl::can
