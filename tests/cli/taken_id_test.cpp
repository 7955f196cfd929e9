// Another unit that comes to a node ID while a servo is on its way there.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <string>

using namespace blactl::test;

namespace {

/// Servo 13 gets ID 23 as the last of three, at about 12 s; another unit with that ID is switched
/// on meanwhile.
struct Moved {
  Result result;
  std::ptrdiff_t rom_writes;
};

Moved move_to_an_id_that_is_taken(const std::string& at) {
  Scene scene;
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const int number : {1, 2, 3}) {
    scene.servo("BLA21-12U-AB", 10 + number, {{"serial_number", number}, {"servo_id", number}});
    entries.push_back({{"name", std::to_string(number)},
                       {"match", {{"serial_number", number}}},
                       {"set", {{"static_node_id", 20 + number}}}});
  }
  scene.servo("BLA21-12U-AB", 23, {{"serial_number", 9}, {"servo_id", 9}}).joins(9, at);
  Fleet fleet(scene);
  Moved moved{fleet.apply({{"schema", "blactl-fleet/1"}, {"servos", entries}}, {"--stagger", "4"}),
              0};
  moved.rom_writes = fleet.rom_writes();
  return moved;
}

} // namespace

TEST_CASE("a servo is not saved for a node ID that another unit has taken meanwhile") {
  const std::string at = GENERATE("4s", "5500ms", "7s", "8500ms", "10s", "11s");
  INFO(at);
  const Moved moved = move_to_an_id_that_is_taken(at);
  CHECK(moved.result.status == 6);
  CHECK(codes(moved.result) == std::vector<std::string>{"duplicate_node_id"});
  CHECK(contains(moved.result.err, "node 13 was written in RAM, in part or whole, and is not "
                                   "saved: node 13 would get node ID 23"));
  CHECK(moved.rom_writes == 2);
  const auto node = json(moved.result.out)["nodes"][2];
  CHECK(node["status"] == "failed");
  CHECK(node["saved"] == false);
  CHECK(node["node_id_after"] == 13);
}

TEST_CASE("a servo that has moved in an earlier round is looked at once more at the end") {
  const std::string at = GENERATE("2550ms", "3s", "3500ms", "4s", "4500ms");
  INFO(at);
  Scene scene;
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const int number : {1, 2}) {
    scene.servo("BLA21-12U-AB", 10 + number, {{"serial_number", number}, {"servo_id", number}});
    entries.push_back({{"name", std::to_string(number)},
                       {"match", {{"serial_number", number}}},
                       {"set", {{"static_node_id", 13 - number}}}});
  }
  scene.servo("BLA21-12U-AB", 11, {{"serial_number", 9}, {"servo_id", 9}}).joins(9, at);
  const Fleet fleet(scene);
  const Result moved = fleet.apply({{"schema", "blactl-fleet/1"}, {"servos", entries}});
  INFO(moved.err);
  CHECK(moved.status != 0);
  CHECK(codes(moved).front() == "duplicate_node_id");
  CHECK_FALSE(contains(moved.err, "has not left"));
}

TEST_CASE("a node ID that RAM held before a SAVE without an end stays in the allocation table") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"never_returns", true}}}}));
  REQUIRE(fleet.run({"set", "-n", "11", "static_node_id=30", "-y"}).status == 0);
  const auto command = GENERATE(Arguments{"save", "-n", "11", "-y"},
                                Arguments{"set", "-n", "11", "smoothing=off", "--save", "-y"});
  check_error(fleet.run(command), 4, "not_back", "leave it powered");
  const auto entries = json(fleet.run({"alloc", "--list", "--json"}).out)["entries"];
  REQUIRE(entries.size() == 1);
  CHECK(entries[0]["node_id"] == 30);
}

TEST_CASE("an ID in the memory of a servo that failed is not given to another one") {
  Scene scene;
  scene.servo("BLA21-12U-AB", 18,
              {{"serial_number", 1}, {"servo_id", 1}, {"faults", {{"refuse_opcodes", true}}}});
  scene.servo("BLA21-12U-AB", 11, {{"serial_number", 2}, {"servo_id", 2}});
  Fleet fleet(scene);
  REQUIRE(fleet.run({"set", "-n", "18", "static_node_id=16", "-y"}).status == 0);
  const Document servos = {
      {{"name", "one"},
       {"match", {{"serial_number", 1}}},
       {"set", {{"static_node_id", 18}, {"smoothing", "off"}}}},
      {{"name", "two"}, {"match", {{"serial_number", 2}}}, {"set", {{"static_node_id", 16}}}}};
  const Result result = fleet.apply({{"schema", "blactl-fleet/1"}, {"servos", servos}});
  INFO(result.err);
  CHECK(result.status != 0);
  CHECK(statuses(result) == std::vector<std::string>{"failed", "failed"});
  CHECK(contains(result.err, "node 11 was to get node ID 16, whose holder has failed"));
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("a servo that fails after it has made way tells the node ID on which it responds") {
  int on_its_way = 0;
  for (int at = 2000; at <= 7000; at += 100) {
    Scene scene;
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    for (const int number : {1, 2}) {
      scene.servo("BLA21-12U-AB", 10 + number, {{"serial_number", number}, {"servo_id", number}});
      entries.push_back({{"name", std::to_string(number)},
                         {"match", {{"serial_number", number}}},
                         {"set", {{"static_node_id", 13 - number}}}});
    }
    scene.foreign(40, {{"armed", true}, {"joins", std::to_string(at) + "ms"}});
    const Fleet fleet(scene);
    const Result moved = fleet.apply({{"schema", "blactl-fleet/1"}, {"servos", entries}});
    INFO(at << moved.err << moved.out);
    const auto got = json(fleet.run({"get", "-n", "serial:1", "static_node_id", "--json"}).out);
    const auto told = json(moved.out)["nodes"];
    if (moved.status != 0 && told.size() == 2) {
      CHECK(told[0]["node_id_after"] == got["nodes"][0]["node_id"]);
      on_its_way += got["nodes"][0]["node_id"] == 125 ? 1 : 0;
    }
  }
  CHECK(on_its_way > 0);
}
