// Servo IDs that change hands while a command works, and units that do.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <algorithm>
#include <string>

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
  CHECK(fleet.rom_writes() == 1);
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
