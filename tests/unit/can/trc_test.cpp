#include "can/log/trc.hpp"
#include "catch.hpp"
#include "time_zone.hpp"

#include <linux/can/error.h>

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using blactl::can::test::TimeZone;

namespace {

using Kind = LogLine::Kind;
using Stamp = LogLine::Stamp;
using Lines = std::vector<std::string>;

const Frame status{.id = 0x1401552A, .size = 8, .data = {0xD2, 4, 0, 0, 0, 7, 0, 0xC0}};
const Frame standard{.id = 0x123, .extended = false, .size = 2, .data = {0xDE, 0xAD}};
const Frame remote{.id = 0x7FF, .extended = false, .remote = true, .size = 5};

const Lines v1_1{";$FILEVERSION=1.1"};
const Lines v1_2{";$FILEVERSION=1.2"};
const Lines v1_3{";$FILEVERSION=1.3"};
const Lines v2_0{";$FILEVERSION=2.0", ";$COLUMNS=N,O,T,I,d,l,D"};
const Lines v2_1{";$FILEVERSION=2.1", ";$COLUMNS=N,O,T,B,I,d,R,L,D"};

/// What a line says behind this header; its interface is the reader's text.
struct Said {
  std::optional<LogLine> line{};
  std::string interface{};

  [[nodiscard]] bool is(Kind kind) const { return line && line->kind == kind; }

  [[nodiscard]] bool is(const Frame& frame) const {
    return is(Kind::frame) && line->frame == frame;
  }
};

Said parse(const Lines& header, std::string_view text) {
  TrcLog log;
  for (const auto& line : header) {
    INFO(line);
    CHECK(log.parse(line));
  }
  const auto line = log.parse(text);
  return {line, line ? std::string(line->interface) : ""};
}

} // namespace

TEST_CASE("TRC: frames of every version") {
  CHECK(parse(v1_1, "     1)      1059.9  Rx     1401552A  8  D2 04 00 00 00 07 00 C0 \r\n")
            .is(status));
  CHECK(parse(v1_1, "1) 1059.9 Tx 0123 2 DE AD").is(standard));
  CHECK(parse(v1_1, "1) 1059.9 Rx 07FF 5 RTR").is(remote));
  CHECK(parse(v1_2, "1) 1059.900 1 Rx 1401552A 8 D2 04 00 00 00 07 00 C0").is(status));
  CHECK(parse(v1_2, "1) 1059.900 2 Rx 07FF 5 RTR").is(remote));
  CHECK(parse(v1_3, "1) 1059.900 1 Rx 1401552A - 8 D2 04 00 00 00 07 00 C0").is(status));
  CHECK(parse(v1_3, "1) 1059.900 2 Rx 07FF - 5 RTR").is(remote));
  CHECK(parse(v2_0, "1 1059.900 DT 1401552A Rx 8  D2 04 00 00 00 07 00 C0").is(status));
  CHECK(parse(v2_0, "1 1059.900 RR 07FF Rx 5").is(remote));
  CHECK(parse(v2_1, "1 1059.900 DT 1 1401552A Rx - 8 D2 04 00 00 00 07 00 C0").is(status));
  CHECK(parse(v2_1, "1 1059.900 RR 1 07FF Rx - 5").is(remote));
  CHECK(parse(v2_1, "1 1059.900 DT 1 0000 Rx - 0").is(Frame{.id = 0, .extended = false}));
  CHECK(parse(v2_1, "1 1059.900 DT 1 0123456 Rx - 0").is(Frame{.id = 0x123456})); // python-can
  CHECK(parse(v2_1, "1 1059.900 DT 1 1401552A Rx - 15 D2 04 00 00 00 07 00 C0").is(status));
}

TEST_CASE("TRC: columns may stand in another order, and some may be missing") {
  CHECK(
      parse({";$FILEVERSION=2.1", ";$COLUMNS=O,B,T,I,l,D"}, "0.1 1 DT 0123 2 DE AD").is(standard));
  for (const auto* columns :
       {"", "N", "N,O,T,B,I,d,R,L", "N,O,T,B,I,d,R,D", "N,O,T,I,L,l,D", "N,O,T,I,X,L,D",
        "N,O,T,D,I,L", "N,O,I,T,L,D", "N,T,I,O,L,D", "N,O,T,I,L,D,R", "N,O,T,T,I,L,D", "NOTILD",
        "N;O;T;I;L;D", "N,,O,T,I,L,D", ",N,O,T,I,L,D", "N,O,T,B,I,d,R,L,D,N,O,T"}) {
    INFO(columns);
    TrcLog log;
    CHECK(log.parse(";$FILEVERSION=2.1"));
    CHECK_FALSE(log.parse(";$COLUMNS=" + std::string(columns)));
    CHECK_FALSE(log.parse("1 1059.900 DT 1 0123 Rx - 2 DE AD"));
  }
}

TEST_CASE("TRC: without a known version, or columns where they are due, there is no frame") {
  TrcLog log;
  CHECK_FALSE(log.parse("1) 1059.9 Rx 0123 2 DE AD"));
  for (const auto* version : {"1.0", "2.2", "3.0", "", "1.1.1", "x", "1.35.255.0"}) {
    CHECK_FALSE(log.parse(";$FILEVERSION=" + std::string(version)));
    CHECK_FALSE(log.parse("1) 1059.9 Rx 0123 2 DE AD"));
    CHECK_FALSE(log.parse(";$COLUMNS=N,O,T,I,d,l,D"));
  }
  CHECK(log.parse(";$FILEVERSION=2.0"));
  CHECK_FALSE(log.parse("1 1059.900 DT 0123 Rx 2 DE AD"));
  CHECK(log.parse(";$FILEVERSION=1.1"));
  CHECK(log.parse("1) 1059.9 Rx 0123 2 DE AD"));
}

TEST_CASE("TRC: a bus is an interface") {
  CHECK(parse(v1_1, "1) 1059.9 Tx 0123 2 DE AD").interface == "can");
  CHECK(parse(v1_2, "1) 1059.900 2 Tx 0123 2 DE AD").interface == "can2");
  CHECK(parse(v2_0, "1 1059.900 DT 0123 Tx 2 DE AD").interface == "can");
  CHECK(parse(v2_1, "1 1059.900 DT 16 0123 Tx - 2 DE AD").interface == "can16");
  CHECK_FALSE(parse(v2_1, "1 1059.900 DT - 0123 Tx - 2 DE AD").line);
  CHECK_FALSE(parse(v2_1, "1 1059.900 DT 256 0123 Tx - 2 DE AD").line);
}

TEST_CASE("TRC: error frames keep their type and place") {
  const std::vector<std::pair<Lines, std::string>> samples{
      {v1_1, "6) 1349.2 Error 0004 4 00 19 08 08"},
      {v1_2, "6) 1349.222 1 Error 0004 4 00 19 08 08"},
      {v1_3, "6) 1349.222 1 Error 0004 - 4 00 19 08 08"},
      {v2_0, "6 1334.522 ER          Rx    04 00 19 08 08"},
      {v2_1, "6 1334.222 ER 1         - Rx -  5    04 00 19 08 08"}};
  for (const auto& [header, text] : samples) {
    INFO(text);
    const auto said = parse(header, text);
    REQUIRE(said.is(Kind::error));
    CHECK(said.line->frame.id == (CAN_ERR_PROT | CAN_ERR_BUSERROR));
    CHECK(said.line->frame.data[2] == CAN_ERR_PROT_STUFF);
    CHECK(said.line->frame.data[3] == CAN_ERR_PROT_LOC_ACK);
  }
  CHECK_FALSE(parse(v1_1, "6) 1349.2 Error").line);
  CHECK_FALSE(parse(v2_0, "6 1334.522 ER").line);
}

TEST_CASE("TRC: what else it says is neither a frame nor a fault") {
  for (const auto* text : {"", " \r\n", ";", ";   Start time: 07.05.2015 11:09:27.047.8", ";$X=1",
                           "5) 1346.8 Warng FFFFFFFF 4 00 00 00 04 BUSLIGHT"}) {
    CHECK(parse(v1_1, text).is(Kind::other));
  }
  for (const auto* text :
       {"7 1334.224 EV 1 User-defined event", "8 1334.225 EV - for all busses",
        "9 1334.231 ST 1 - Rx - 4 00 00 00 08", "11 1334.643 EC 1 - Rx - 2 02 02",
        "5 1334.416 FD 1 0500 Tx - 9 01 02 03 04 05 06 07 08 09 0A 0B 0C",
        "5 1334.416 FB 1 0500 Tx - 1 01", "5 1334.416 FE 1 0500 Tx - 1 01",
        "5 1334.416 BI 1 0500 Tx - 1 01"}) {
    INFO(text);
    CHECK(parse(v2_1, text).is(Kind::other));
  }
}

TEST_CASE("TRC: a line that is wrong or cut off is none") {
  for (const std::string text : {"dear diary",
                                 "1)",
                                 "1) 1059.9",
                                 "1) 1059.9 Rx",
                                 "1) 1059.9 Rx 0123",
                                 "1) 1059.9 Rx 0123 2",
                                 "1) 1059.9 Rx 0123 2 DE",
                                 "1) 1059.9 Rx 0123 2 DE A",
                                 "1) 1059.9 Rx 0123 2 DE AD BE",
                                 "1) 1059.9 Rx 0123 2 DE XY",
                                 "1) 1059.9 Rx 0123 16 DE",
                                 "1) 1059.9 Rx 0123 -1",
                                 "1) 1059.9 Rx 0123 99999999999",
                                 "1) 1059.9 Rx 0800 0",
                                 "1) 1059.9 Rx 123 0",
                                 "1) 1059.9 Rx 12345 0",
                                 "1) 1059.9 Rx 20000000 0",
                                 "1) 1059.9 Rx 123456789 0",
                                 "1) 1059.9 Rx 0XYZ 0",
                                 "1) 1059.9 Rx FFFFFFFF 0",
                                 "1) 1059.9 Ry 0123 0",
                                 "1) 1059.9 Rx 0123 2 RTR RTR",
                                 "1) 1059 Rx 0123 0",
                                 "1) -1.0 Rx 0123 0",
                                 "1) 123456789012.0 Rx 0123 0",
                                 "1) 1.0e3 Rx 0123 0",
                                 "x) 1059.9 Rx 0123 0",
                                 ") 1059.9 Rx 0123 0"}) {
    INFO(text);
    CHECK_FALSE(parse(v1_1, text).line);
  }
  for (const std::string text :
       {"1 1059.900", "1 1059.900 DT", "1 1059.900 XX 1 0123 Rx - 0", "1 1059.900 dt 1 0123 Rx - 0",
        "1 1059.900 RR 1 0123 Rx - 1 00", "1 1059.900 DT 1 0123 Rx - 8 00 00 00 00 00 00 00"}) {
    INFO(text);
    CHECK_FALSE(parse(v2_1, text).line);
  }
  CHECK_FALSE(parse(v2_0, "1 1059.900 DT 0123 Rx 9 00 00 00 00 00 00 00 00 00").line);
  CHECK_FALSE(parse(v1_1, std::string_view("1) 1059.9 Rx 0123 1 \0\0", 22)).line);
}

TEST_CASE("TRC: times are milliseconds after the start, which is local") {
  const auto at = [](const std::string& start, std::string_view offset) {
    auto header = v1_1;
    header.push_back(";$STARTTIME=" + start);
    const auto said = parse(header, "1) " + std::string(offset) + " Rx 0123 0");
    REQUIRE(said.line);
    CHECK(said.line->stamp == Stamp::absolute);
    return said.line->at;
  };
  constexpr WallTime noon = std::chrono::sys_days(std::chrono::year(2014) / 5 / 7) + 12h;
  {
    const TimeZone utc("UTC0");
    CHECK(at("41766.5", "0.0") == noon);
    CHECK(at("41766.5;", "1059.9") == noon + 1059ms + 900us);
    CHECK(at("41766.5", "1059.9009") == noon + 1059ms + 900us);
    CHECK(at("41766.500000001", "0.0") == noon + 86us);
    CHECK(at("41766.50000000000000000000000001", "0.0") == noon);
    CHECK(at("25569.0", "0.0") == WallTime());
    CHECK(at("401768.999999999999", "0.0") ==
          std::chrono::sys_days(std::chrono::year(3000) / 1 / 1) - 1us);
  }
  const TimeZone tokyo("JST-9");
  CHECK(at("41766.5", "0.0") == noon - 9h);
}

TEST_CASE("TRC: a start that cannot be read is told, and times count from it") {
  for (const auto* start : {"", "x", "41766", "41766.", ".5", "-1.5", "401769.0", "2958465.0",
                            "1e5.0", "0.0", "99999999999999999999.5", "41766,5"}) {
    INFO(start);
    TrcLog log;
    CHECK(log.parse(";$FILEVERSION=1.1"));
    CHECK_FALSE(log.parse(";$STARTTIME=" + std::string(start)));
    const auto line = log.parse("1) 1059.9 Rx 0123 0");
    REQUIRE(line);
    CHECK(line->stamp == Stamp::relative);
    CHECK(line->at == WallTime(1059ms + 900us));
  }
}

TEST_CASE("TRC: it is told by its version") {
  CHECK(TrcLog::begins(";$FILEVERSION=1.1\r\n"));
  CHECK_FALSE(TrcLog::begins(";   Start time"));
  CHECK_FALSE(TrcLog::begins("1) 1059.9 Rx 0123 0"));
}
