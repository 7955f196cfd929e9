#include "blactl/base/crc16.hpp"

#include "can/mcast_datagram.hpp"
#include "catch.hpp"

#include <random>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::can;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const Frame& frame) {
  const Datagram datagram = to_datagram(frame);
  return {datagram.view().begin(), datagram.view().end()};
}

/// A datagram made by hand: everything after the CRC, which is put before it and fits.
Bytes sealed(Bytes rest, std::uint16_t magic = 0x2934) {
  const std::uint16_t crc = crc16(rest);
  Bytes bytes{static_cast<std::uint8_t>(magic), static_cast<std::uint8_t>(magic >> 8U),
              static_cast<std::uint8_t>(crc), static_cast<std::uint8_t>(crc >> 8U)};
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

/// Flags, message ID and so many bytes of data.
Bytes rest(std::uint16_t flags, std::uint32_t id, std::size_t data) {
  Bytes bytes{static_cast<std::uint8_t>(flags),     static_cast<std::uint8_t>(flags >> 8U),
              static_cast<std::uint8_t>(id),        static_cast<std::uint8_t>(id >> 8U),
              static_cast<std::uint8_t>(id >> 16U), static_cast<std::uint8_t>(id >> 24U)};
  bytes.resize(bytes.size() + data, 0x5A);
  return bytes;
}

} // namespace

// The bytes were made with struct.pack and binascii.crc_hqx of Python.
TEST_CASE("a frame becomes a datagram of exactly these bytes") {
  CHECK(bytes_of({.id = 0x1E01'8AFF, .size = 1, .data = {0xC0}}) ==
        Bytes{0x34, 0x29, 0x6A, 0xCB, 0x00, 0x00, 0xFF, 0x8A, 0x01, 0x9E, 0xC0});
  CHECK(bytes_of({.id = 0x1401'552A, .size = 8, .data = {0xD2, 4, 0, 0, 0, 7, 0, 0xC0}}) ==
        Bytes{0x34, 0x29, 0xD1, 0x79, 0x00, 0x00, 0x2A, 0x55, 0x01, 0x94, 0xD2, 4, 0, 0, 0, 7, 0,
              0xC0});
  CHECK(bytes_of({.id = 0x7FF, .extended = false}) ==
        Bytes{0x34, 0x29, 0x23, 0xC0, 0x00, 0x00, 0xFF, 0x07, 0x00, 0x00});
}

TEST_CASE("frames of every kind and length survive the way through a datagram") {
  for (std::uint8_t size = 0; size <= 8; ++size) {
    for (const bool extended : {true, false}) {
      Frame frame{.id = 0x123, .extended = extended, .size = size};
      for (std::uint8_t i = 0; i < size; ++i) {
        frame.data[i] = static_cast<std::uint8_t>(0xF0 + i);
      }
      CHECK(from_datagram(to_datagram(frame).view()) == frame);
      const Frame remote{.id = 0x123, .extended = extended, .remote = true, .size = size};
      CHECK(from_datagram(to_datagram(remote).view()) == remote);
    }
  }
  const Frame highest{.id = extended_id_mask, .size = 8};
  CHECK(from_datagram(to_datagram(highest).view()) == highest);
}

TEST_CASE("a frame that says more than eight bytes is cut, and so is too large an ID") {
  CHECK(bytes_of({.id = 1, .size = 200}).size() == Datagram::max_size);
  CHECK(from_datagram(bytes_of({.id = 0xFFFF'FFFF})) == Frame{.id = extended_id_mask});
  CHECK(from_datagram(bytes_of({.id = 0xFFF, .extended = false})) ==
        Frame{.id = 0x7FF, .extended = false});
}

TEST_CASE("one wrong bit anywhere makes a datagram unreadable") {
  const Bytes whole = bytes_of({.id = 0x1401'552A, .size = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}});
  REQUIRE(from_datagram(whole));
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes damaged = whole;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    CAPTURE(bit);
    CHECK_FALSE(from_datagram(damaged));
  }
}

TEST_CASE("only 10 to 18 bytes are a datagram") {
  for (std::size_t size = 0; size < 10; ++size) {
    CHECK_FALSE(from_datagram(Bytes(size, 0)));
  }
  CHECK(from_datagram(sealed(rest(0, 0x8000'0001, 0))));
  CHECK(from_datagram(sealed(rest(0, 0x8000'0001, 8))));
  for (const std::size_t data : {9U, 12U, 64U, 65U, 1'400U}) { // 64: 74 bytes, a full FD frame
    CHECK_FALSE(from_datagram(sealed(rest(0, 0x8000'0001, data))));
  }
}

TEST_CASE("another magic is none of ours, however well the CRC fits") {
  CHECK_FALSE(from_datagram(sealed(rest(0, 0x8000'0001, 2), 0x2935)));
  CHECK_FALSE(from_datagram(sealed(rest(0, 0x8000'0001, 2), 0x3429)));
}

TEST_CASE("frames of CAN FD are not taken for classic ones, short ones neither") {
  for (const std::size_t data : {0U, 3U, 8U, 64U}) {
    CHECK_FALSE(from_datagram(sealed(rest(1, 0x8000'0001, data))));
  }
}

TEST_CASE("flags without a meaning are passed over") {
  CHECK(from_datagram(sealed(rest(0xFFFE, 0x8000'0001, 2))) ==
        Frame{.id = 1, .size = 2, .data = {0x5A, 0x5A}});
}

TEST_CASE("error frames and standard frames with an extended ID are dropped") {
  CHECK_FALSE(from_datagram(sealed(rest(0, 0x2000'0040, 8))));
  CHECK_FALSE(from_datagram(sealed(rest(0, 0xA000'0040, 8))));
  CHECK_FALSE(from_datagram(sealed(rest(0, 0x0000'0800, 1))));
  CHECK_FALSE(from_datagram(sealed(rest(0, 0x1401'552A, 1))));
  CHECK(from_datagram(sealed(rest(0, 0x0000'07FF, 1))));
}

TEST_CASE("noise is no frame") {
  std::mt19937 random(1); // NOLINT: the same every time
  int frames = 0;
  for (int i = 0; i < 10'000; ++i) {
    Bytes noise(random() % 80);
    for (auto& byte : noise) {
      byte = static_cast<std::uint8_t>(random());
    }
    frames += from_datagram(noise) ? 1 : 0;
  }
  CHECK(frames == 0);
}
