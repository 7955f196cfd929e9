#include "blactl/fleet/files/fleet_file_editor.hpp"

#include "catch.hpp"
#include "unit/fleet/support.hpp"

#include <string>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

Snapshot a_unit() {
  Snapshot unit{.servo = {.id = NodeId(12), .is_servo = true}};
  unit.servo.unique_id = dronecan::UniqueId{0xAB, 0xCD};
  unit.servo.identity = bla::Identity(
      profiles(),
      {.model_number = 21030, .serial_number = 7, .firmware_version = 1400, .hardware_version = 1});
  return unit;
}

Result<std::string> edited(const std::string& text, const std::string& name) {
  return with_unit(text, "fleet.json", name, a_unit(), {.time = {}, .tool_version = "1.2"});
}

std::string file(const std::string& entry) {
  return "{\"schema\":\"blactl-fleet/1\",\r\n\t\"servos\" : [{\"name\":\"a\",\"match\":"
         "{\"serial_number\":1}} ," +
         entry + "]}";
}

} // namespace

TEST_CASE("only what names the unit of the entry is replaced, the rest stays byte for byte") {
  CHECK(edited(file(R"({"match":{"unique_id" : "00","serial_number":2 },"name":"b"})"), "b") ==
        file(R"({"match":{"unique_id" : "abcd0000000000000000000000000000","serial_number":7 },)"
             R"("name":"b"})"));
  CHECK(edited(file(R"({"name":"b","match":{"serial_number":2}})"), "a") ==
        file(R"({"name":"b","match":{"serial_number":2}})")
            .replace(file("").find(":1}") + 1, 1, "7"));
  const std::string by_id = file(R"({"name":"b","match":{"servo_id":2},"set":{"servo_id":2}})");
  CHECK(edited(by_id, "b") == by_id);
}

TEST_CASE("a name with escapes is found, and strings may hold what looks like structure") {
  CHECK(edited(file(R"({"name":"\u0062\"]}","match":{"serial_number":2,"model":"{\"}"}})"),
               "b\"]}") ==
        file(R"({"name":"\u0062\"]}","match":{"serial_number":7,"model":"{\"}"}})"));
}

TEST_CASE("about tells of the new unit, as far as the entry tells anything") {
  CHECK(edited(file(R"({"name":"b","match":{"servo_id":2},"about":{"firmware_version":1,)"
                    R"("production_date":"2024-09-01 10:00","tool_version":"0.1"}})"),
               "b") ==
        file(R"({"name":"b","match":{"servo_id":2},"about":{"firmware_version":1400,)"
             R"("production_date":"unknown","tool_version":"1.2"}})"));
  const auto untold =
      edited(file(R"({"name":"b","match":{"servo_id":2},"about":{"time":"x"}})"), "b");
  REQUIRE_FALSE(untold);
  CHECK(untold.error().code == Code::timeout);
}

TEST_CASE("an entry that is not there, or a file that is none, is an error") {
  CHECK(edited(file(R"({"name":"b"})"), "c").error().code == Code::bad_file);
  CHECK(edited("[]", "c").error().code == Code::bad_file);
  CHECK(edited("{", "c").error().code == Code::bad_file);
}
