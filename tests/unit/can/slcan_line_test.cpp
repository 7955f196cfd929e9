#include "blactl/can/slcan_line.hpp"

#include "catch.hpp"

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

using namespace blactl::can;
using Kind = SlcanLine::Kind;

namespace {

std::vector<SlcanLine> parse(std::string_view bytes) {
  SlcanParser parser;
  std::vector<SlcanLine> lines;
  for (const char byte : bytes) {
    if (const auto line = parser.take(byte)) {
      lines.push_back(*line);
    }
  }
  return lines;
}

std::vector<Kind> kinds(std::string_view bytes) {
  std::vector<Kind> found;
  for (const SlcanLine& line : parse(bytes)) {
    found.push_back(line.kind);
  }
  return found;
}

std::vector<Frame> frames(std::string_view bytes) {
  std::vector<Frame> found;
  for (const SlcanLine& line : parse(bytes)) {
    if (line.kind == Kind::frame) {
      found.push_back(line.frame);
    }
  }
  return found;
}

const Frame status{.id = 0x1401552A, .size = 8, .data = {0xD2, 4, 0, 0, 0, 7, 0, 0xC0}};

/// Any frame that slcan can carry.
Frame random_frame(std::mt19937& random) {
  Frame frame;
  frame.extended = random() % 4 != 0;
  frame.remote = random() % 8 == 0;
  frame.id = static_cast<std::uint32_t>(random()) & (frame.extended ? extended_id_mask : 0x7FFU);
  frame.size = static_cast<std::uint8_t>(random() % 9);
  for (std::size_t i = 0; i < frame.size && !frame.remote; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(random());
  }
  return frame;
}

} // namespace

TEST_CASE("frames are written as the lines of slcan") {
  CHECK(to_slcan(status) == "T1401552A8D2040000000700C0\r");
  CHECK(to_slcan({.id = 0x1E018AFF, .size = 1, .data = {0xC0}}) == "T1E018AFF1C0\r");
  CHECK(to_slcan({.id = 0x12, .size = 0}) == "T000000120\r");
  CHECK(to_slcan({.id = 0x12, .extended = false, .size = 2, .data = {0x0A, 0xFF}}) ==
        "t01220AFF\r");
  CHECK(to_slcan({.id = 0x12, .remote = true, .size = 8}) == "R000000128\r");
  CHECK(to_slcan({.id = 0x12, .extended = false, .remote = true, .size = 3}) == "r0123\r");
}

TEST_CASE("a frame is read in upper and lower case, with and without a time") {
  for (const std::string_view line :
       {"T1401552A8D2040000000700C0\r", "T1401552a8d2040000000700c0\r",
        "T1401552A8D2040000000700C0EA5F\r", "T1401552A8d2040000000700c0ffff\r",
        "T1401552A8D2040000000700C0\n", "T1401552A8D2040000000700C0\r\n"}) {
    INFO(line);
    CHECK(frames(line) == std::vector{status});
  }
}

TEST_CASE("what an adapter marks as its own frame is no frame of another node") {
  CHECK(kinds("T1401552A8D2040000000700C0L\r") == std::vector{Kind::loopback});
  CHECK(kinds("T1401552A8D2040000000700C01234L\r") == std::vector{Kind::loopback});
}

TEST_CASE("every frame survives being written and read") {
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const Frame frame = random_frame(random);
    const std::string line = to_slcan(frame);
    CAPTURE(line);
    const auto read = frames(line);
    REQUIRE(read.size() == 1);
    REQUIRE(read.front() == frame);
  }
}

TEST_CASE("answers are told apart: done, refused, told, anything else") {
  CHECK(kinds("\rZ\rz\r\a") == std::vector{Kind::done, Kind::done, Kind::done, Kind::refused});
  CHECK(kinds("F00\rV1010\rN0123456789ABCDEF0123456789ABCDEF\rV1.0-beta\r") ==
        std::vector(4, Kind::told));
  CHECK(kinds("O\rF\rF0\rF0G\rV\rN\rN 1\rN,1\r") == std::vector(8, Kind::other));
  CHECK(kinds("\r\n\r\n") == std::vector(2, Kind::done)); // the line feeds answer nothing
}

TEST_CASE("lines that are no frame of classic CAN are skipped whole") {
  const std::string data(128, 'A');
  for (const std::string& line :
       {std::string("T1401552A9D2040000000700C0"), std::string("T1401552AFD2040000000700C0"),
        std::string("T2000000000"), std::string("T1401552A8D2040000000700C"),
        std::string("T1401552A8D2040000000700C0123"), std::string("T1401552A8D2040000000700C0L1"),
        std::string("T1401552G0"), std::string("T-1401552A0"), std::string("T 1401552A0"),
        std::string("t8000"), std::string("t12"), "D1401552AF" + data, "d123F" + data,
        "B1401552AF" + data, "b123F" + data}) {
    INFO(line);
    CHECK(kinds(line + '\r') == std::vector{Kind::other});
    CHECK(frames(line + '\r' + to_slcan(status)) == std::vector{status});
  }
}

TEST_CASE("a frame that lost its end does not take the next one with it") {
  for (std::size_t cut = 0; cut < 26; ++cut) {
    const std::string whole = to_slcan(status);
    INFO(cut);
    CHECK(frames(whole.substr(0, cut) + whole) == std::vector{status});
  }
}

TEST_CASE("binary garbage before a frame is harmless") {
  CHECK(frames(std::string("\xFD\x09\x00\x00\x15\x01\x01\xFF", 8) + to_slcan(status)) ==
        std::vector{status});
  CHECK(kinds(std::string("\xFD\x09\x00", 3) + "\r") == std::vector{Kind::other}); // not "done"
  CHECK(frames(std::string(100'000, 'A') + to_slcan(status)) == std::vector{status});
}

TEST_CASE("no garbage breaks the parser, and after it frames are read again") {
  std::mt19937 random(2);
  for (int round = 0; round < 200; ++round) {
    SlcanParser parser;
    for (int i = 0; i < 5'000; ++i) {
      // Bytes of the protocol more often than others: they reach further into it.
      constexpr std::string_view likely = "TtRrdDbB0123456789ABCDEFabcdefLZz\r\n\a";
      const char byte =
          random() % 3 == 0 ? static_cast<char>(random()) : likely[random() % likely.size()];
      if (const auto line = parser.take(byte); line && line->kind == Kind::frame) {
        REQUIRE(line->frame.size <= 8);
        REQUIRE(line->frame.id <= (line->frame.extended ? extended_id_mask : 0x7FFU));
      }
    }
    std::vector<Frame> found;
    for (const char byte : to_slcan(status)) {
      if (const auto line = parser.take(byte); line && line->kind == Kind::frame) {
        found.push_back(line->frame);
      }
    }
    REQUIRE(found == std::vector{status});
  }
}

TEST_CASE("a parser holds one line at most") {
  CHECK(sizeof(SlcanParser) <= 64);
}
