#include "can/gunzip.hpp"

#include <new>

#define ZLIB_CONST // its input is not written to
#include <zlib.h>

namespace blactl::can {
namespace {

/// The largest window of deflate, and gzip's header and trailer only (zlib.h, inflateInit2).
constexpr int gzip_only = 15 + 16;

} // namespace

struct Gunzip::Stream {
  z_stream z{};
};

Gunzip::Gunzip() : stream_(std::make_unique<Stream>()) {
  if (inflateInit2(&stream_->z, gzip_only) != Z_OK) {
    throw std::bad_alloc(); // nothing else can fail here
  }
}

Gunzip::~Gunzip() {
  inflateEnd(&stream_->z);
}

void Gunzip::take(std::span<const char> packed) {
  stream_->z.next_in = reinterpret_cast<const Bytef*>(packed.data());
  stream_->z.avail_in = static_cast<uInt>(packed.size());
}

std::size_t Gunzip::unpack(std::span<char> room) {
  z_stream& z = stream_->z;
  z.next_out = reinterpret_cast<Bytef*>(room.data());
  z.avail_out = static_cast<uInt>(room.size());
  while (!damaged_ && z.avail_out > 0) {
    if (whole_ && z.avail_in > 0) { // the output of the next run of gzip
      inflateReset(&z);
      whole_ = false;
    }
    const int result = whole_ ? Z_BUF_ERROR : inflate(&z, Z_NO_FLUSH);
    if (result == Z_BUF_ERROR) { // not a fault: it needs more input
      break;
    }
    whole_ = result == Z_STREAM_END;
    damaged_ = result != Z_OK && !whole_;
  }
  return room.size() - z.avail_out;
}

} // namespace blactl::can
