#include "can/log/asc.hpp"
#include "catch.hpp"
#include "time_zone.hpp"

#include <linux/can/error.h>

#include <chrono>
#include <string>
#include <string_view>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using blactl::can::test::TimeZone;

namespace {

using Kind = LogLine::Kind;
using Stamp = LogLine::Stamp;

constexpr std::string_view hex_absolute = "base hex  timestamps absolute";

const Frame status{.id = 0x1401552A, .size = 8, .data = {0xD2, 4, 0, 0, 0, 7, 0, 0xC0}};

/// What the last of these lines says; the others must be lines of the log too.
std::optional<LogLine> last_of(AscLog& log, std::initializer_list<std::string_view> lines) {
  std::optional<LogLine> found;
  for (const auto line : lines) {
    INFO(line);
    CHECK((found || line == *lines.begin()));
    found = log.parse(line);
  }
  return found;
}

/// What a line says in a log of these numbers and times.
std::optional<LogLine> parse(std::string_view line, std::string_view base = hex_absolute) {
  AscLog log;
  const auto found = last_of(log, {base, line});
  // its interface is the reader's text
  return found ? std::optional(LogLine{found->kind, found->stamp, found->frame, found->at, {}})
               : std::nullopt;
}

bool is_frame(std::string_view line, const Frame& frame, std::string_view base = hex_absolute) {
  const auto found = parse(line, base);
  return found && found->kind == Kind::frame && found->frame == frame;
}

bool is_other(std::string_view line) {
  const auto found = parse(line);
  return found && found->kind == Kind::other;
}

/// Where `date` is the measurement's start, the time of a line 1.5 s later; empty: there is none.
std::optional<WallTime> time_after(const std::string& date) {
  AscLog log;
  const bool is_read = log.parse(date).has_value();
  const auto line = last_of(log, {hex_absolute, "1.500000 1 123 Rx d 0"});
  REQUIRE(line);
  CHECK(is_read == (line->stamp == Stamp::absolute));
  return is_read ? std::optional(line->at) : std::nullopt;
}

constexpr WallTime afternoon =
    std::chrono::sys_days(std::chrono::year(2017) / 9 / 30) + 15h + 6min + 13s + 191ms;

} // namespace

TEST_CASE("ASC: data and remote frames, standard and extended, hexadecimal and decimal") {
  CHECK(is_frame("   1.000000 1  1401552Ax       Rx   d 8 D2 04 00 00 00 07 00 C0  Length = 273910 "
                 "BitCount = 141 ID = 335631658x\r\n",
                 status));
  CHECK(is_frame("1.0 1 1401552ax Tx d 8 d2 04 00 00 00 07 00 c0", status));
  CHECK(is_frame("1.0 1 1401552AX Rx d 8 D2 04 00 00 00 07 00 C0 TE", status));
  CHECK(is_frame("1.0\t1\t1401552Ax\tRx\td\t8\tD2\t04\t00\t00\t00\t07\t00\tC0", status));
  CHECK(is_frame("1.0 1 335631658x Rx d 8 210 4 0 0 0 7 0 192 Length = 273910", status,
                 "base dec timestamps absolute"));
  CHECK(is_frame("1.0 1 7FF Rx d 0", {.id = 0x7FF, .extended = false}));
  CHECK(is_frame("1.0 1 0x Rx d 0", {.id = 0}));
  CHECK(is_frame("1.0 1 123 Rx r", {.id = 0x123, .extended = false, .remote = true}));
  CHECK(is_frame("1.0 1 123 Rx r Length = 1704000 BitCount = 145 ID = 291",
                 {.id = 0x123, .extended = false, .remote = true}));
  CHECK(is_frame("1.0 1 123x Rx r 5 Length = 1704000", {.id = 0x123, .remote = true, .size = 5}));
}

TEST_CASE("ASC: a length code above eight means eight bytes") {
  CHECK(is_frame("1.0 1 1401552Ax Rx d F D2 04 00 00 00 07 00 C0", status));
  CHECK(is_frame("1.0 1 123 Rx r 9", {.id = 0x123, .extended = false, .remote = true, .size = 8}));
}

TEST_CASE("ASC: a channel is an interface") {
  AscLog log;
  CHECK(last_of(log, {hex_absolute, "1.0 1 123 Rx d 0"})->interface == "can1");
  CHECK(log.parse("1.0 255 123 Rx d 0")->interface == "can255");
  CHECK_FALSE(log.parse("1.0 256 123 Rx d 0"));
  CHECK_FALSE(log.parse("1.0 99999999999999999999 123 Rx d 0"));
}

TEST_CASE("ASC: an error frame is one without detail") {
  for (const auto* text :
       {"2.501000 1 ErrorFrame", "3.501000 1 ErrorFrame ECC: 10100010",
        "4.5 2 ErrorFrame Flags = 0xe CodeExt = 0x20a2 Code = 0x82 ID = 0",
        "1.0 CANFD 5 Tx ErrorFrame Not Acknowledge error, dominant error flag"}) {
    const auto line = parse(text);
    REQUIRE(line);
    CHECK(line->kind == Kind::error);
    CHECK(line->frame.id == CAN_ERR_BUSERROR);
  }
}

TEST_CASE("ASC: what else it says is neither a frame nor a fault") {
  for (const auto* text :
       {"", "  ", "// version 9.0.0", "//0.000000 previous log file: x.asc",
        "internal events logged", "no internal events logged", "Begin Triggerblock",
        "Begin TriggerBlock Sam Sep 30 15:06:13.191 2017", "End TriggerBlock",
        "0.000000 Start of measurement",
        "0.015991 CAN 1 Status:chip status error passive - TxErr: 132 RxErr: 0",
        "1.015991 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%",
        "3.297743 1  J1939TP FEE3p        6    0  0   -   Rx   d 23 A0 0F A6 60 3B D1 40 1F",
        "1.0 Li 3d Rx 8 00 00 00 00 00 00 00 00 checksum = 0", "1.0 SV: 2 0 1 ::Speed = 3",
        // a wish to send; what was sent has a line of its own
        "1.0 1 123 TxRq d 2 DE AD"}) {
    INFO(text);
    CHECK(is_other(text));
  }
}

TEST_CASE("ASC: CAN FD is no frame, but a classic frame of a channel that can do it is one") {
  CHECK(
      is_other("0.045636 CANFD   62 Rx         88                                   0 1 8  8 00 "
               "00 f6 90 00 00 00 00   105812  137   303000 d001b0b3 46500250 4b140250 20011736"));
  CHECK(is_other("1.0 CANFD 1 Rx 716 Name 1 0 9 12 12 3b 36 01 7b 0a 20 20 20 20 22 66 0 0 1000"));
  CHECK(is_frame("1.0 CANFD 1 Rx 1401552Ax 0 0 8 8 d2 04 00 00 00 07 00 c0 141000 141 200000 b0b3",
                 status));
  CHECK(is_frame("1.0 CANFD 1 Rx 1401552Ax Status 0 0 8 8 d2 04 00 00 00 07 00 c0 141000 141 0",
                 status, "base dec timestamps absolute"));
  CHECK(is_frame("1.0 CANFD 1 Rx 7FF 0 0 5 0 56000 56 200010 b0b3",
                 {.id = 0x7FF, .extended = false, .remote = true, .size = 5}));
  CHECK(is_other("1.0 CANFD 1 TxRq 7FF 0 0 0 0 0 0 0"));
  for (const auto* text :
       {"1.0 CANFD", "1.0 CANFD 1", "1.0 CANFD 1 Rx", "1.0 CANFD 1 Rx 7FF",
        "1.0 CANFD 1 Rx 7FF 0 0 8 8 d2 04 00 00 00 07 00 c0",
        "1.0 CANFD 1 Rx 7FF 0 0 8 8 d2 04 00 00 00 07 00 c0 141000 141",
        "1.0 CANFD 1 Rx 7FF 0 0 8 7 d2 04 00 00 00 07 00 141000 141 0",
        "1.0 CANFD 1 Rx 7FF 0 0 9 12 1 2 3 4 5 6 7 8 9 10 11 12 0 0 0",
        "1.0 CANFD 1 Rx 7FF 0 0 5 5 01 02 03 04 05 0 0 10", "1.0 CANFD 1 Rx 800 0 0 0 0 0 0 0",
        "1.0 CANFD 1 Rx 7FF 0 0 f 65 00", "1.0 CANFD x Rx 7FF 0 0 0 0 0 0 0",
        "1.0 CANFD 1 Rx 7FF 0 0 0 0 0 0 123456789"}) {
    INFO(text);
    CHECK_FALSE(parse(text));
  }
}

TEST_CASE("ASC: a line that is wrong or cut off is none") {
  for (const std::string text : {"dear diary",
                                 "1.0",
                                 "1.0 ",
                                 "1.0 1",
                                 "1.0 1 123",
                                 "1.0 1 123 R",
                                 "1.0 1 123 Rx",
                                 "1.0 1 123 Rx x 0",
                                 "1.0 1 123 Rx d",
                                 "1.0 1 123 Rx d 2",
                                 "1.0 1 123 Rx d 2 DE",
                                 "1.0 1 123 Rx d 2 DE A",
                                 "1.0 1 123 Rx d 2 DE AD BE",
                                 "1.0 1 123 Rx d 2 DE XY",
                                 "1.0 1 123 Rx d 2 DE -1",
                                 "1.0 1 123 Rx d 2 DE 0xA",
                                 "1.0 1 123 Rx d 10",
                                 "1.0 1 123 Rx d G",
                                 "1.0 1 800 Rx d 0",
                                 "1.0 1 20000000x Rx d 0",
                                 "1.0 1 123456789x Rx d 0",
                                 "1.0 1 x Rx d 0",
                                 "1.0 1 Name Rx d 0",
                                 "1.0 1 -1 Rx d 0",
                                 "1.0 1x 123 Rx d 0",
                                 "1 1 123 Rx d 0",
                                 "1. 1 123 Rx d 0",
                                 ".5 1 123 Rx d 0",
                                 "1.x 1 123 Rx d 0",
                                 "-1.0 1 123 Rx d 0",
                                 "1,5 1 123 Rx d 0",
                                 "123456789012.0 1 123 Rx d 0",
                                 "99999999999.0 1 123 Rx d 0",
                                 "0x1.0 1 123 Rx d 0",
                                 "1.0e3 1 123 Rx d 0",
                                 "date",
                                 "base",
                                 "base oct timestamps absolute",
                                 "base hex",
                                 "base hex timestamps",
                                 "base hex timestamps now",
                                 "begin",
                                 "no"}) {
    INFO(text);
    CHECK_FALSE(parse(text));
  }
  CHECK_FALSE(parse(std::string_view("1.0 1 123 Rx d 1 \0\0", 19)));
  CHECK_FALSE(parse("1.0 1 123 Rx d 1 256", "base dec timestamps absolute"));
  CHECK_FALSE(parse("1.0 1 12A Rx d 0", "base dec timestamps absolute"));
  CHECK_FALSE(parse("1.0 1 2048 Rx d 0", "base dec timestamps absolute"));
  CHECK_FALSE(parse("1.0 1 536870912x Rx d 0", "base dec timestamps absolute"));
  CHECK_FALSE(parse("1.0 1 99999999999x Rx d 0", "base dec timestamps absolute"));
}

TEST_CASE("ASC: without a readable base there is no frame") {
  AscLog log;
  CHECK_FALSE(log.parse("1.0 1 123 Rx d 0"));
  CHECK(log.parse(hex_absolute));
  CHECK(log.parse("1.0 1 123 Rx d 0"));
  CHECK_FALSE(log.parse("base oct timestamps absolute"));
  CHECK_FALSE(log.parse("1.0 1 123 Rx d 0"));
}

TEST_CASE("ASC: dates are English or German, of 24 or of 12 hours") {
  const TimeZone utc("UTC0");
  const auto expected = afternoon + 1500ms;
  for (const std::string date :
       {"date Sat Sep 30 15:06:13.191 2017", "date Sam Sep 30 15:06:13.191 2017\r\n",
        "DATE sat sep 30 03:06:13.191 PM 2017", "date  Sat  Sep  30  03:06:13.191  pm  2017"}) {
    INFO(date);
    CHECK(time_after(date) == expected);
  }
  const auto on = [](int month, int day) {
    return WallTime(std::chrono::sys_days(std::chrono::year(2017) / month / day)) + 1500ms;
  };
  CHECK(time_after("date Son M\xC3\xA4r 5 00:00:00 2017") == on(3, 5));
  CHECK(time_after("date Son M\xE4r 5 00:00:00 2017") == on(3, 5));
  CHECK(time_after("date Son Mrz 5 00:00:00 2017") == on(3, 5));
  CHECK(time_after("date Die Mai 2 12:00:00 am 2017") == on(5, 2));
  CHECK(time_after("date Mit Okt 4 12:00:00.000 pm 2017") == on(10, 4) + 12h);
  CHECK(time_after("date Don Dez 7 11:59:59 pm 2017") == on(12, 8) - 1s);
  CHECK(time_after("date Wed May 31 00:00:00.000000 2017") == on(5, 31));
}

TEST_CASE("ASC: a date that cannot be read is told, and times count from the start") {
  for (const std::string date : {"date",
                                 "date Sat",
                                 "date Xxx Sep 30 15:06:13 2017",
                                 "date Sat Foo 30 15:06:13 2017",
                                 "date Sat Sep 31 15:06:13 2017",
                                 "date Sat Sep 0 15:06:13 2017",
                                 "date Sat Sep 30 24:06:13 2017",
                                 "date Sat Sep 30 15:60:13 2017",
                                 "date Sat Sep 30 15:06:60 2017",
                                 "date Sat Sep 30 15:06 2017",
                                 "date Sat Sep 30 15:06:13. 2017",
                                 "date Sat Sep 30 15:06:13.x 2017",
                                 "date Sat Sep 30 15:06:13 pm 2017",
                                 "date Sat Sep 30 00:06:13 am 2017",
                                 "date Sat Sep 30 03:06:13 xm 2017",
                                 "date Sat Sep 30 15:06:13",
                                 "date Sat Sep 30 15:06:13 pm",
                                 "date Sat Sep 30 15:06:13 1969",
                                 "date Sat Sep 30 15:06:13 3000",
                                 "date Sat Sep 30 15:06:13 99999",
                                 "date Sat Sep 30 15:06:13 99999999999999999999",
                                 "date Sat Sep 30 15:06:13 2017 x",
                                 "date 2017-09-30",
                                 "date Sat Feb 29 15:06:13 2017"}) {
    INFO(date);
    CHECK_FALSE(time_after(date));
  }
  const auto line = parse("1.25 1 123 Rx d 0");
  REQUIRE(line);
  CHECK(line->stamp == Stamp::relative);
  CHECK(line->at == WallTime(1250ms));
}

TEST_CASE("ASC: dates are those of this time zone") {
  const TimeZone tokyo("JST-9");
  CHECK(time_after("date Sat Sep 30 15:06:13.191 2017") == afternoon + 1500ms - 9h);
  const TimeZone berlin("CET-1CEST,M3.5.0,M10.5.0/3");
  CHECK(time_after("date Sat Sep 30 15:06:13.191 2017") == afternoon + 1500ms - 2h);
}

TEST_CASE("ASC: relative times count from the line before, whatever it says") {
  const TimeZone utc("UTC0");
  AscLog log;
  const auto line =
      last_of(log, {"date Sat Sep 30 15:06:13.191 2017", "base hex timestamps relative",
                    "1.000000 1 123 Rx d 0", "0.250000 1 Statistic: D 0 R 0",
                    "0.250000 1 ErrorFrame", "0.500000 2 123 Rx d 0"});
  REQUIRE(line);
  CHECK(line->at == afternoon + 2s);
  CHECK(log.parse("0.000001 1 123 Rx d 0")->at == afternoon + 2s + 1us);
}

TEST_CASE("ASC: times that add up to more than a log can last are refused, not overflowed") {
  AscLog log;
  CHECK(last_of(log, {"base hex timestamps relative", "31000000000.0 1 123 Rx d 0"}));
  for (int i = 0; i < 1000; ++i) {
    CHECK_FALSE(log.parse("31000000000.0 1 123 Rx d 0"));
  }
  CHECK(log.parse("1.0 1 123 Rx d 0"));
}

TEST_CASE("ASC: the measurement began when its block says, if the block holds its start") {
  const TimeZone utc("UTC0");
  AscLog log;
  // python-can writes its first line before the first frame comes
  CHECK(last_of(log, {"date Sat Sep 30 15:00:00.000 2017", hex_absolute,
                      "Begin Triggerblock Sat Sep 30 15:06:13.191 2017",
                      "0.000000 Start of measurement", "1.0 1 123 Rx d 0"})
            ->at == afternoon + 1s);
  // of a trigger that came later, times still count from the start
  CHECK(last_of(log, {"date Sat Sep 30 15:06:13.191 2017", hex_absolute,
                      "Begin Triggerblock Sat Sep 30 15:07:13.191 2017", "60.5 1 123 Rx d 0"})
            ->at == afternoon + 60s + 500ms);
  CHECK(log.parse("61.0 Start of measurement"));
  CHECK(log.parse("61.5 1 123 Rx d 0")->at == afternoon + 61s + 500ms);
  AscLog undated;
  CHECK(last_of(undated, {hex_absolute, "Begin Triggerblock Sat Sep 30 15:06:13.191 2017",
                          "60.5 1 123 Rx d 0", "61.5 1 123 Rx d 0"})
            ->at == afternoon + 1s);
}

TEST_CASE("ASC: it is told by its first lines") {
  CHECK(AscLog::begins("date Sat Sep 30 15:06:13.191 2017"));
  CHECK(AscLog::begins("date Die Sep 30 15:06:13.191 2017\r"));
  CHECK(AscLog::begins("base hex  timestamps absolute"));
  for (const auto* text :
       {"", "date", "date  123 [0]", "base 123#00", "vcan0 123#00", "dear diary"}) {
    CHECK_FALSE(AscLog::begins(text));
  }
}
