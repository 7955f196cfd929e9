#include "blactl/can/candump.hpp"

#include "catch.hpp"

#include <chrono>
#include <random>
#include <string>
#include <string_view>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;

namespace {

using Kind = LogLine::Kind;
using Stamp = LogLine::Stamp;

const Frame status{.id = 0x1401552A, .size = 8, .data = {0xD2, 4, 0, 0, 0, 7, 0, 0xC0}};
const Frame standard{.id = 0x123, .extended = false, .size = 4, .data = {0xDE, 0xAD, 0xBE, 0xEF}};
const Frame remote{.id = 0x123, .extended = false, .remote = true};
const Frame remote_of_five{.id = 0x123, .extended = false, .remote = true, .size = 5};
const Frame one_byte{.id = 0x1E018AFF, .size = 1, .data = {0xC0}};
const Frame empty{.id = 0};
const Frame empty_standard{.id = 0x7FF, .extended = false};

LogLine parse(std::string_view text) {
  INFO(text);
  const auto line = parse_line(text);
  REQUIRE(line);
  return *line;
}

WallTime at(std::int64_t microseconds) {
  return WallTime(Duration(microseconds));
}

struct Sample {
  std::string_view text;
  Frame frame;
};

} // namespace

// Every line of this file that is quoted with an interface was printed by candump of can-utils
// 2020.11.

TEST_CASE("candump -l: time, interface and frame") {
  const LogLine line = parse("(1795270858.168743) vcan0 1401552A#D2040000000700C0");
  CHECK(line.kind == Kind::frame);
  CHECK(line.frame == status);
  CHECK(line.stamp == Stamp::absolute);
  CHECK(line.at == at(1795270858'168743));
  CHECK(line.interface == "vcan0");
  CHECK(parse("(1795270858.371462) vcan0 123#DEADBEEF").frame == standard);
  CHECK(parse("(1795270858.513133) vcan0 123#R").frame == remote);
  CHECK(parse("(1795270858.663395) vcan0 123#R5").frame == remote_of_five);
  CHECK(parse("(1795270858.812151) vcan0 1E018AFF#C0").frame == one_byte);
  CHECK(parse("(1795270858.959539) vcan0 00000000#").frame == empty);
  CHECK(parse("(1795270859.108194) vcan0 7FF#\r\n").frame == empty_standard);
}

TEST_CASE("a log of several interfaces pads their names") {
  const LogLine line = parse("(1795270859.877778)   vc1 1FFFFFFF#0102030405060708");
  CHECK(line.interface == "vc1");
  CHECK(line.frame == Frame{.id = 0x1FFFFFFF, .size = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}});
}

TEST_CASE("-x adds the direction") {
  CHECK(parse("(1795270858.168743) vcan0 1401552A#D2040000000700C0 T").frame == status);
  CHECK(parse("(1795270858.513133) vcan0 123#R R").frame == remote);
  CHECK(parse("(1795270859.108194) vcan0 7FF# T").frame == empty_standard);
  CHECK(parse("  vcan0  TX - -  1401552A   [8]  D2 04 00 00 00 07 00 C0").frame == status);
  CHECK(parse("  vcan0  RX - -       123   [0]  remote request").frame == remote);
  CHECK(parse("  vcan0  TX B -  1401552A  [02]  AA BB").kind == Kind::other);
}

TEST_CASE("nine decimals are cut to microseconds, fewer are filled up") {
  CHECK(parse("(1436509052.249713999) can0 123#R").at == at(1436509052'249713));
  CHECK(parse("(1436509052.2) can0 123#R").at == at(1436509052'200000));
}

TEST_CASE("CAN FD and CAN XL are neither ours nor an error") {
  for (const auto* text :
       {"(1795270859.257111) vcan0 123##4112233", "(1795270859.438327) vcan0 1401552A##5AABB T",
        "  vcan0       123  [03]  11 22 33", "  vcan0  1401552A  [02]  AA BB",
        "(1795270859.438327) vcan0 45123#81:00:12345678#1122"}) {
    CHECK(parse(text).kind == Kind::other);
  }
}

TEST_CASE("error frames keep their class and detail") {
  for (const auto* text :
       {"(1795270859.731030) vcan0 20000004#0004000000000000",
        " (1795270859.731030)  vcan0  20000004   [8]  00 04 00 00 00 00 00 00   ERRORFRAME"}) {
    const LogLine line = parse(text);
    CHECK(line.kind == Kind::error);
    CHECK(line.frame.id == 4);
    CHECK(line.frame.size == 8);
    CHECK(line.frame.data[1] == 4);
  }
}

TEST_CASE("what candump says between frames is no frame and no fault") {
  for (const auto* text : {"", " ", "\n", "\tcontroller-problem{rx-error-warning}", "\tbus-error",
                           "DROPCOUNT: dropped 3 CAN frames on 'vcan0' socket (total drops 3)"}) {
    CHECK(parse(text).kind == Kind::other);
  }
}

TEST_CASE("candump's screen format, with and without its time stamps") {
  const std::vector<Sample> samples{
      {"vcan0  1401552A   [8]  D2 04 00 00 00 07 00 C0", status},
      {"vcan0       123   [4]  DE AD BE EF", standard},
      {"vcan0       123   [0]  remote request", remote},
      {"vcan0       123   [5]  remote request", remote_of_five},
      {"vcan0  1E018AFF   [1]  C0", one_byte},
      {"vcan0  00000000   [0] ", empty},
      {"vcan0       7FF   [0] ", empty_standard},
      {"vcan0  1401552A   [8]  D2 04 00 00 00 07 00 C0   '........'", status},
      {"vcan0       123   [4]  DE AD BE EF               '....'", standard},
      {"vcan0  00000000   [0]                            ''", empty},
  };

  struct Time {
    std::string_view text;
    Stamp stamp;
    WallTime at;
  };

  const auto date = std::chrono::sys_days(std::chrono::year(2026) / 11 / 21) + 14h + 20min;
  for (const auto& [stamp_text, stamp, time] :
       {Time{"", Stamp::none, {}},
        Time{"(1795270858.168743)", Stamp::absolute, at(1795270858168743)},
        Time{"(000.202719)", Stamp::relative, at(202719)},
        Time{"(1234567.000001)", Stamp::relative, at(1234567'000001)},
        Time{"(2026-11-21 14:20:58.168743)", Stamp::absolute, WallTime(date + 58'168'743us)}}) {
    for (const auto& [text, frame] : samples) {
      const std::string whole = " " + std::string(stamp_text) + "  " + std::string(text);
      const LogLine line = parse(whole);
      CHECK(line.kind == Kind::frame);
      CHECK(line.frame == frame);
      CHECK(line.stamp == stamp);
      CHECK(line.at == time);
      CHECK(line.interface == "vcan0");
    }
  }
}

TEST_CASE("what other tools write into such logs is taken as canplayer does") {
  CHECK(parse("(0000000001.000000) can0 123#DE.AD.BE.EF").frame == standard);
  CHECK(parse("(0000000001.000000) can0 1401552a#d2040000000700c0").frame == status);
  CHECK(parse("(0000000001.000000) can0 1401552A#D2040000000700C0_E").frame == status);
  CHECK(parse("(0000000001.000000) can0 123#R8_9").frame.size == 8);
}

TEST_CASE("anything else is no line of candump") {
  for (const auto* text : {
           "garbage",
           "(",
           "()",
           "(.5) can0 123#",
           "(1436509052) can0 123#",
           "(1436509052.) can0 123#",
           "(1436509052.249713 can0 123#",
           "(-436509052.249713) can0 123#",
           "(143650905224.971300) can0 123#", // no time that anybody logged
           "(99999999999999999999.000000) can0 123#",
           "(2026-13-21 14:20:58.168743) can0 123#",
           "(2026-02-30 14:20:58.168743) can0 123#",
           "(2026-11-21 24:20:58.168743) can0 123#",
           "(2026-11-21T14:20:58.168743) can0 123#",
           "(1436509052.249713)",
           "(1436509052.249713) can0",
           "(1436509052.249713) can0 ",
           "(1436509052.249713) 123#00", // no interface
           "(1436509052.249713) can0 #",
           "(1436509052.249713) can0 12#00",
           "(1436509052.249713) can0 1234#00",
           "(1436509052.249713) can0 800#00", // 11 bits
           "(1436509052.249713) can0 FFFFFFFF#00",
           "(1436509052.249713) can0 40000000#00",
           "(1436509052.249713) can0 1401552G#00",
           "(1436509052.249713) can0 123#0",
           "(1436509052.249713) can0 123#0G",
           "(1436509052.249713) can0 123#001122334455667788",
           "(1436509052.249713) can0 123#1122_E",
           "(1436509052.249713) can0 123#R9",
           "(1436509052.249713) can0 123#RX",
           "(1436509052.249713) can0 123#R55",
           "(1436509052.249713) can0 123#00 X",
           "(1436509052.249713) can0 123#00 T (1436509052.249713)",
           "(1436509052.249713) can0 123 00",
           "can0  123   [9]  00 11 22 33 44 55 66 77 88",
           "can0  123   [2]  00",
           "can0  123   [2]  00 1",
           "can0  123   [2]  00 1G",
           "can0  123   []  00",
           "can0  123   [x]  00",
           "can0  123   [0]  remote",
           "  vcan0  1401552A   [8]  C0`00`07`00`00`00`04`D2",             // -S
           "  vcan0       123   [4]  11011110 10101101 10111110 11101111", // -i
           "  \x1b[1m\x1b[34mvcan0  1E018AFF   [1]  C0\x1b[0m",            // -c -c
       }) {
    INFO(text);
    CHECK_FALSE(parse_line(text));
  }
}

TEST_CASE("any bytes at all are read without harm") {
  std::mt19937 random(1); // NOLINT(cert-msc51-cpp): the same bytes in every run
  const std::string_view alphabet = "()0123456789ABCDEF#R[].: -T_can\t\n\r\0\xFF"; // likely ones
  const std::string_view real = "(1436509052.249713) can0 1401552A#D2040000000700C0 T";
  std::size_t frames = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::string text(real.substr(0, random() % (real.size() + 1)));
    for (auto changes = random() % 4; changes > 0 && !text.empty(); --changes) {
      text[random() % text.size()] = alphabet[random() % alphabet.size()];
    }
    const auto line = parse_line(text);
    frames += line && line->kind == Kind::frame ? 1U : 0U;
    if (line && line->frame.size > 8) {
      FAIL(text);
    }
  }
  CHECK(frames > 1000);
}

TEST_CASE("a line is written as candump writes it") {
  LineBuffer buffer;
  const auto time = at(1436509052'249713);
  CHECK(format_line(status, time, "can0", buffer) ==
        "(1436509052.249713) can0 1401552A#D2040000000700C0\n");
  CHECK(format_line(standard, at(7), "vcan0", buffer) ==
        "(0000000000.000007) vcan0 123#DEADBEEF\n");
  CHECK(format_line(remote, time, "can0", buffer) == "(1436509052.249713) can0 123#R\n");
  CHECK(format_line(remote_of_five, time, "can0", buffer) == "(1436509052.249713) can0 123#R5\n");
  CHECK(format_line(empty, time, "can0", buffer) == "(1436509052.249713) can0 00000000#\n");
  CHECK(format_line(empty, at(-5), "can0", buffer) == "(0000000000.000000) can0 00000000#\n");
  CHECK(format_line(empty, time, "a_name_of_more_than_15_bytes", buffer) ==
        "(1436509052.249713) a_name_of_more_ 00000000#\n");
  const auto latest = WallTime::max();
  CHECK(format_line(status, latest, "a_name_of_more_than_15_bytes", buffer).ends_with("C0\n"));
}

TEST_CASE("what was written is read as it was") {
  std::mt19937_64 random(2); // NOLINT(cert-msc51-cpp): the same frames in every run
  LineBuffer buffer;
  for (int i = 0; i < 100'000; ++i) {
    Frame frame;
    frame.extended = random() % 2 == 0;
    frame.remote = random() % 8 == 0;
    frame.id = static_cast<std::uint32_t>(random()) & (frame.extended ? extended_id_mask : 0x7FFU);
    frame.size = static_cast<std::uint8_t>(random() % 9);
    for (std::size_t j = 0; j < frame.size && !frame.remote; ++j) {
      frame.data[j] = static_cast<std::uint8_t>(random());
    }
    const auto time = at(static_cast<std::int64_t>(random() % 99'999'999'999'000'000));
    const auto text = format_line(frame, time, "vcan0", buffer);
    const auto line = parse_line(text);
    if (!line || line->kind != Kind::frame || line->frame != frame || line->at != time ||
        line->stamp != Stamp::absolute || line->interface != "vcan0") {
      FAIL(text);
    }
  }
}
