#include "blactl/fleet/files/label.hpp"

#include "catch.hpp"
#include "unit/fleet/support.hpp"

#include <string>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

TEST_CASE("a label is a serial number, however its line ends") {
  for (const char* line : {"240900558", "  240900558\r\n", "\t240900558 "}) {
    const auto label = parse_label(line, 1, profiles());
    REQUIRE(label);
    CHECK(label->serial_number == 240900558);
    CHECK(label->text == "240900558");
    CHECK_FALSE(label->servo_id);
  }
  CHECK(parse_label("4294967295", 1, profiles())->serial_number == 4294967295);
}

TEST_CASE("a label says more as an object") {
  const auto label = parse_label(
      R"( {"serial_number": 7, "servo_id": 3, "static_node_id": 11, "work_order": "W-1",
           "operator": "田中"} )",
      1, profiles());
  REQUIRE(label);
  CHECK(label->serial_number == 7);
  CHECK(label->servo_id == 3);
  CHECK(label->static_node_id == 11);
  CHECK(label->work_order == "W-1");
  CHECK(label->operator_name == "田中");
  CHECK_FALSE(parse_label("{}", 1, profiles())->serial_number);
}

TEST_CASE("what is no label is told with its number, and is not printed raw") {
  for (const char* line :
       {"", "  ", "abc", "-1", "+1", "1.0", "0x10", "4294967296", "12 34", "[1]", "{",
        "{\"serial\": 1}", "{\"servo_id\": 255}", "{\"static_node_id\": 126}",
        "{\"static_node_id\": 0}", "{\"serial_number\": \"7\"}", "\x1b[2J7"}) {
    INFO(line);
    const auto label = parse_label(line, 42, profiles());
    REQUIRE_FALSE(label);
    CHECK(label.error().code == Code::bad_file);
    CHECK(label.error().message.find("label 42") == 0);
    CHECK(label.error().message.find('\x1b') == std::string::npos);
  }
}
