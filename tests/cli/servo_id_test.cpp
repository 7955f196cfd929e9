// Servo IDs that change hands while a command works, and units that do.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

constexpr int servo_id_register = 0x45;

Scene numbered() {
  Scene scene;
  for (const int number : {1, 2, 3}) {
    scene.servo("BLA21-12U-AB", 10 + number, {{"serial_number", number}, {"servo_id", number}});
  }
  return scene;
}

/// Another node writes this servo ID to that node, at a time in ms.
nlohmann::json gives(int at, int node, int servo_id) {
  return {{"at", std::to_string(at) + "ms"},
          {"to", node},
          {"order", "write"},
          {"address", servo_id_register},
          {"value", servo_id}};
}

Document exchange_of_servo_ids() {
  Document entries = Document::array();
  for (const int number : {1, 2}) {
    entries.push_back({{"name", std::to_string(number)},
                       {"match", {{"serial_number", number}}},
                       {"set", {{"servo_id", 3 - number}}}});
  }
  return {{"schema", "blactl-fleet/1"}, {"servos", entries}};
}

/// Servo 1 gets the ID of servo 2, and so on; the last one that of the first.
Document ring_of_servo_ids(int size) {
  Document entries = Document::array();
  for (int number = 1; number <= size; ++number) {
    entries.push_back({{"name", std::to_string(number)},
                       {"match", {{"serial_number", number}}},
                       {"set", {{"servo_id", number % size + 1}}}});
  }
  return {{"schema", "blactl-fleet/1"}, {"servos", entries}};
}

/// Servos 1 to 3; that with the number `failing` does not do as it is told.
Scene numbered_with(int failing, const nlohmann::json& faults) {
  Scene scene;
  for (const int number : {1, 2, 3}) {
    nlohmann::json more{{"serial_number", number}, {"servo_id", number}};
    if (number == failing) {
      more["faults"] = faults;
    }
    scene.servo("BLA21-12U-AB", 10 + number, more);
  }
  return scene;
}

} // namespace

TEST_CASE("what is for a servo ID is not done to a servo that has lost it to another meanwhile") {
  const auto command =
      GENERATE(Arguments{"set", "-n", "servo:2", "smoothing=off", "--save"},
               Arguments{"save", "-n", "servo:2"}, Arguments{"restart", "-n", "servo:2"},
               Arguments{"apply", "FILE", "--no-save"},
               Arguments{"command", "angle=10deg", "-n", "servo:2", "--duration", "0.2"});
  INFO(command.front());
  int refused = 0;
  for (int at = 300; at < 1500; at += 90) { // before it acts
    Scene scene = numbered();
    scene.foreign(100, {{"orders", {gives(at, 12, 5), gives(at + 5, 11, 2)}}});
    Fleet fleet(scene);
    Arguments words = command;
    words.insert(words.end(), {"-y", "--json"});
    std::ranges::replace(
        words, "FILE",
        fleet.file(
            {{"schema", "blactl-fleet/1"},
             {"servos",
              {{{"name", "two"}, {"match", {{"servo_id", 2}}}, {"set", {{"angle_p_gain", 7}}}}}}}));
    const Result result = fleet.run(words);
    INFO(at << ' ' << result.out << result.err);
    refused += result.status != 0 ? 1 : 0;
    const bool is_stream = command.front() == "command";
    const nlohmann::json document = is_stream ? json_lines(result.out).front() : json(result.out);
    const auto nodes = document.value("nodes", nlohmann::json::array({document}));
    for (const auto& node : nodes) {
      CHECK_FALSE((result.status == 0 && node.value("servo_id", 2) != 2));
    }
  }
  CHECK(refused > 0);
}

TEST_CASE("a servo ID that another node has given to another servo meanwhile is not saved") {
  const int at = GENERATE(2300, 2700, 3100);
  Scene scene = numbered();
  scene.foreign(100, {{"orders", {gives(at, 13, 1)}}});
  Fleet fleet(scene);
  const Result applied = fleet.apply(exchange_of_servo_ids(), {"--stagger", "2"});
  INFO(at << ' ' << applied.out << applied.err);
  CHECK(applied.status != 0);
  CHECK(contains(applied.err, "duplicate_servo_id"));
  CHECK(fleet.rom_writes() == 3); // both make way, and one gets its ID
}

TEST_CASE("two servos never end with one servo ID in ROM, whichever fails in an exchange") {
  const int size = GENERATE(2, 3);
  const int failing = GENERATE(1, 2, 3);
  if (failing > size) {
    return;
  }
  const Fleet fleet(numbered_with(failing, {{"refuse_opcodes", true}}));
  const Result applied = fleet.apply(ring_of_servo_ids(size));
  INFO(size << ' ' << failing << applied.out << applied.err);
  CHECK(applied.status != 0);
  std::set<std::int64_t> in_rom;
  for (int number = 1; number <= 3; ++number) { // that which refuses SAVE refuses a restart, too
    in_rom.insert(number == failing ? number : fleet.rom(std::to_string(10 + number), "servo_id"));
  }
  CHECK(in_rom.size() == 3);
}

TEST_CASE("servo IDs change hands in a ring, and each is in the ROM of one servo") {
  const int size = GENERATE(2, 3);
  Fleet fleet(numbered());
  const Result applied = fleet.apply(ring_of_servo_ids(size));
  INFO(applied.out << applied.err);
  CHECK(applied.status == 0);
  std::vector<std::string> expected(3, "extra");
  std::fill_n(expected.begin(), size, "changed");
  CHECK(statuses(applied) == expected);
  CHECK(contains(applied.err, "makes way for others"));
  const auto document = json(applied.out);
  CHECK(document["nodes"][0]["changes"][0]["before"] == 1);
  CHECK(document["nodes"][0]["changes"][0]["after"] == 2);
  CHECK(fleet.apply(ring_of_servo_ids(size)).status == 0);
  for (int number = 1; number <= size; ++number) {
    CHECK(fleet.rom(std::to_string(10 + number), "servo_id") == number % size + 1);
  }
}

TEST_CASE("a servo gets the servo ID of one that gives it up, once that is proven") {
  const bool fails = GENERATE(false, true);
  Fleet fleet(numbered_with(fails ? 2 : 0, {{"refuse_opcodes", true}}));
  const Document servos = {
      {{"name", "one"}, {"match", {{"serial_number", 1}}}, {"set", {{"servo_id", 2}}}},
      {{"name", "two"}, {"match", {{"serial_number", 2}}}, {"set", {{"servo_id", 9}}}}};
  const Result applied = fleet.apply({{"schema", "blactl-fleet/1"}, {"servos", servos}});
  INFO(applied.out << applied.err);
  CHECK((applied.status == 0) == !fails);
  if (fails) {
    CHECK(contains(applied.err, "node 11 was to get servo ID 2, whose holder has failed"));
  }
  CHECK(fleet.rom("11", "servo_id") == (fails ? 1 : 2));
  CHECK(fleet.rom_writes() == (fails ? 0 : 2));
}

TEST_CASE("a servo ID in RAM that the ROM of another servo holds is not saved") {
  Fleet fleet(numbered());
  REQUIRE(fleet.apply(exchange_of_servo_ids(), {"--no-save"}).status == 0);
  SECTION("one of them alone") {
    const auto command = GENERATE(Arguments{"save", "-n", "11", "-y"},
                                  Arguments{"set", "-n", "11", "servo_id=2", "--save", "-y"},
                                  Arguments{"set", "-n", "11", "angle_p_gain=45", "--save", "-y"},
                                  Arguments{"alloc", "--static", "-n", "11", "--id", "30", "-y"});
    check_error(fleet.run(command), 9, "duplicate_servo_id",
                "node 11 would have servo ID 2, which node 12 has in its ROM");
  }
  SECTION("both together are") {
    CHECK(fleet.run({"save", "-n", "11,12", "-y"}).status == 0);
    CHECK(fleet.rom("11", "servo_id") == 2);
    CHECK(fleet.rom("12", "servo_id") == 1);
  }
}

TEST_CASE("two servos that take turns at one plug are not made one") {
  for (int gone = 85; gone < 110; ++gone) { // about when scan asks who it is
    Scene scene;
    scene.servo("BLA21-12U-AB", 20, {{"serial_number", 1001}, {"unique_id", std::string(32, '1')}})
        .servo("BLA21-12U-AB", 20, {{"serial_number", 1002}, {"unique_id", std::string(32, '2')}})
        .world(1002, {{"plugged", "off"}}, "0ms");
    const auto at = [&](int later) { return std::to_string(gone + later) + "ms"; };
    scene.world(1001, {{"plugged", "off"}}, at(0)).world(1002, {{"plugged", "on"}}, at(300));
    scene.world(1002, {{"plugged", "off"}}, at(700)).world(1001, {{"plugged", "on"}}, at(1000));
    const Result result = scene.run({"scan", "--json"});
    INFO(gone << ' ' << result.out << result.err);
    const auto nodes = json(result.out)["nodes"];
    for (const auto& node : nodes) {
      const bool is_told = node.value("unique_id", nlohmann::json()).is_string() &&
                           node.value("serial_number", nlohmann::json()).is_number();
      if (is_told) {
        const char digit = node["serial_number"] == 1001 ? '1' : '2';
        CHECK(node["unique_id"] == std::string(32, digit));
      }
    }
  }
}
