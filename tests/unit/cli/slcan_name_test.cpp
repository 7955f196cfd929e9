#include "catch.hpp"
#include "cli/interface/slcan_name.hpp"

#include <chrono>
#include <string>

using namespace blactl;
using namespace blactl::cli;
using namespace std::chrono_literals;
using can::SlcanOpening;

TEST_CASE("slcan: a device alone has the options of the contract") {
  const auto name = parse_slcan("/dev/ttyUSB0");
  REQUIRE(name);
  CHECK(name->device == "/dev/ttyUSB0");
  CHECK(name->options.baud == 1'000'000);
  CHECK(name->options.opening == SlcanOpening::careful);
  CHECK(name->options.await_answers);
  CHECK_FALSE(name->options.gap);
  CHECK(parse_slcan("ttyACM3")->device == "/dev/ttyACM3");
}

TEST_CASE("slcan: every option is taken, in any order") {
  const auto name = parse_slcan("/dev/x?gap=0&ack=none&open=plain&baud=115200");
  REQUIRE(name);
  CHECK(name->options.baud == 115200);
  CHECK(name->options.opening == SlcanOpening::plain);
  CHECK_FALSE(name->options.await_answers);
  CHECK(name->options.gap == 0ms);
  const auto other = parse_slcan("/dev/x?open=s8&ack=auto&gap=12");
  REQUIRE(other);
  CHECK(other->options.opening == SlcanOpening::s8);
  CHECK(other->options.await_answers);
  CHECK(other->options.gap == 12ms);
}

TEST_CASE("slcan: what is not understood is refused, and the hint names all options") {
  for (const std::string text :
       {"", "?baud=1000000", "/dev/x?baud=1", "/dev/x?baud=", "/dev/x?baud=1e6", "/dev/x?open=s6",
        "/dev/x?ack=yes", "/dev/x?gap=-1", "/dev/x?gap=1001", "/dev/x?gap=0.5", "/dev/x?speed=1",
        "/dev/x?open", "/dev/x?=", "/dev/x?&", "/dev/x?gap=1&gap=1", "/dev/x?gap=1?ack=none",
        "/dev/x?Open=plain"}) {
    INFO(text);
    const auto name = parse_slcan(text);
    REQUIRE_FALSE(name);
    CHECK(name.error().code == Code::usage);
    for (const char* key : {"baud=", "open=plain,s8", "ack=auto,none", "gap="}) {
      CHECK(name.error().hint.find(key) != std::string::npos);
    }
  }
}
