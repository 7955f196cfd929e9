#pragma once
// A text as gzip packs it.

#include "catch.hpp"

#include <zlib.h>

#include <string>
#include <string_view>

namespace blactl::test {

inline std::string gzipped(std::string_view text) {
  z_stream z{};
  constexpr int gzip_only = 15 + 16;
  REQUIRE(deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_only, 8, Z_DEFAULT_STRATEGY) ==
          Z_OK);
  std::string in(text);
  std::string out(deflateBound(&z, in.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(in.data());
  z.avail_in = static_cast<uInt>(in.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  REQUIRE(deflate(&z, Z_FINISH) == Z_STREAM_END);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

} // namespace blactl::test
