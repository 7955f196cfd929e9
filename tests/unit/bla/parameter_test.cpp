#include "blactl/bla/parameter.hpp"

#include "catch.hpp"

#include <limits>

using namespace blactl::bla;

TEST_CASE("addresses are written with two upper-case digits") {
  CHECK(Address(0x2A).name() == "0x2A");
  CHECK(Address(0x00).name() == "0x00");
}

TEST_CASE("addresses are read in either case, with two digits, up to 0x5F") {
  CHECK(find_address("0x2A") == Address(0x2A));
  CHECK(find_address("0X2a") == Address(0x2A));
  CHECK(find_address("0x00") == Address(0x00));
  CHECK(find_address("0x5F") == Address(0x5F));
  for (const char* text : {"", "0x", "0x2", "0x02A", "2A", "0x60", "0xFF", "0x-1", "0x+1", "0x 1",
                           "1x2A", "0xG0", "0x0G"}) {
    INFO(text);
    CHECK_FALSE(find_address(text));
  }
}

TEST_CASE("groups have the words of the contract") {
  for (const char* word : {"command", "status", "operation", "fault", "config", "control", "pwm",
                           "limit", "option", "product", "production"}) {
    const auto group = find_group(word);
    REQUIRE(group);
    CHECK(name(*group) == word);
  }
  CHECK_FALSE(find_group("Config"));
  CHECK_FALSE(find_group(""));
}

TEST_CASE("a register's number is the low bits of what the servo sends, sign-extended",
          "[requirement-76]") {
  constexpr Width int8{8, true};
  constexpr Width uint8{8, false};
  constexpr Width int16{16, true};
  constexpr Width uint16{16, false};
  constexpr Width int32{32, true};
  constexpr Width uint32{32, false};
  CHECK(int8.narrow(-40) == -40);
  CHECK(int8.narrow(0xD8) == -40); // not sign-extended by the servo
  CHECK(int16.narrow(0xFFFF) == -1);
  CHECK(int16.narrow(-1800) == -1800);
  CHECK(int32.narrow(0xFFFFFFFF) == -1);
  CHECK(int32.narrow(-360'000'000) == -360'000'000);
  CHECK(uint8.narrow(-1) == 255);
  CHECK(uint16.narrow(60'000) == 60'000);
  CHECK(uint16.narrow(-1) == 65'535);
  CHECK(uint32.narrow(-1) == 4'294'967'295);
  CHECK(uint32.narrow(std::numeric_limits<std::int64_t>::min()) == 0);
  CHECK(int8.holds(0xD8));
  CHECK(uint8.holds(-128));
  CHECK_FALSE(uint8.holds(-129));
  CHECK_FALSE(uint8.holds(999));
  CHECK(int32.holds(0xFFFFFFFF));
  CHECK_FALSE(int32.holds((std::int64_t{1} << 32) + 900));
  CHECK(int8.lowest() == -128);
  CHECK(int8.highest() == 127);
  CHECK(uint32.lowest() == 0);
  CHECK(uint32.highest() == 4'294'967'295);
  CHECK(int32.lowest() == -2'147'483'648);
  CHECK(int32.highest() == 2'147'483'647);
}

TEST_CASE("a register exists from its firmware on") {
  Parameter parameter;
  CHECK(parameter.exists_in(0));
  parameter.min_firmware = 1100;
  CHECK_FALSE(parameter.exists_in(1099));
  CHECK(parameter.exists_in(1100));
}
