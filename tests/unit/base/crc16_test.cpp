#include "blactl/base/crc16.hpp"

#include "catch.hpp"

#include <string_view>
#include <vector>

using namespace blactl;

TEST_CASE("the CRC is CRC-16/CCITT-FALSE") {
  const std::string_view check = "123456789";
  const std::vector<std::uint8_t> bytes(check.begin(), check.end());
  CHECK(crc16(bytes) == 0x29B1);
  CHECK(crc16({}) == 0xFFFF);
  CHECK(crc16(std::span(bytes).subspan(4), crc16(std::span(bytes).first(4))) == 0x29B1);
}
