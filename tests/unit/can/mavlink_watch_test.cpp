#include "can/mavlink_watch.hpp"
#include "catch.hpp"

#include <string>

using blactl::can::MavlinkWatch;

namespace {

bool is_heard(const std::string& bytes) {
  MavlinkWatch watch;
  for (const char byte : bytes) {
    watch.take(static_cast<std::uint8_t>(byte));
  }
  return watch.has_heard();
}

std::string version_1(std::size_t length) {
  return std::string{'\xFE', static_cast<char>(length)} + std::string(length + 6, 'x');
}

std::string version_2(std::size_t length, bool is_signed = false) {
  return std::string{'\xFD', static_cast<char>(length), static_cast<char>(is_signed)} +
         std::string(length + 9 + (is_signed ? 13 : 0), 'x');
}

} // namespace

TEST_CASE("frames of MAVLink that follow each other are heard, of any length and version") {
  CHECK(is_heard(version_1(9) + version_1(0)));
  CHECK(is_heard(version_2(9) + version_2(255)));
  CHECK(is_heard(version_2(0, true) + version_2(9)));
  CHECK(is_heard("x\xFD\x01 and then, out of the middle of a frame, " + version_1(255) +
                 version_1(3) + version_1(4)));
}

TEST_CASE("one frame is not enough, and neither is one that ends elsewhere than it says") {
  CHECK_FALSE(is_heard(version_1(9)));
  CHECK_FALSE(is_heard(version_1(9) + "x" + version_1(9)));
  CHECK_FALSE(is_heard(version_1(9) + version_2(9)));
  CHECK_FALSE(is_heard("T1401552A8D2040000000700C0\rZ\r\a"));
}
