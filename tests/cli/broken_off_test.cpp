// An exchange of node IDs that breaks off, wherever that is: what is said of each servo agrees with
// its memory.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <map>
#include <string>

using namespace blactl::test;

namespace {

/// Servos 1 to 3 exchange their IDs 11 to 13 in a circle; the interface is cut after this time.
Result exchange(const Fleet& fleet, bool by_apply) {
  if (!by_apply) {
    return fleet.run({"alloc", "--static", "--assign", "000000000000000000000000000000a1=12",
                      "--assign", "000000000000000000000000000000a2=13", "--assign",
                      "000000000000000000000000000000a3=11", "-y", "--json"});
  }
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const int number : {1, 2, 3}) {
    entries.push_back({{"name", std::to_string(number)},
                       {"match", {{"serial_number", number}}},
                       {"set", {{"static_node_id", 11 + number % 3}, {"smoothing", "off"}}}});
  }
  return fleet.apply({{"schema", "blactl-fleet/1"}, {"servos", entries}});
}

Scene cut_at(int after_ms) {
  Scene scene;
  for (const int number : {1, 2, 3}) {
    scene.servo("BLA21-12U-AB", 10 + number,
                {{"serial_number", number},
                 {"servo_id", number},
                 {"unique_id", "000000000000000000000000000000a" + std::to_string(number)}});
  }
  return scene.clients("cut", std::to_string(after_ms) + "ms")
      .clients("joined", std::to_string(after_ms + 300) + "ms");
}

/// The node ID of each servo, by its serial number.
std::map<int, int> places(const Fleet& fleet) {
  std::map<int, int> ids;
  const auto document = json(fleet.run({"scan", "--json"}).out);
  for (const auto& node : document["nodes"]) {
    ids[node["serial_number"].get<int>()] = node["node_id"].get<int>();
  }
  return ids;
}

} // namespace

TEST_CASE("of a servo that has made way nobody says that it is as it was") {
  const bool by_apply = GENERATE(true, false);
  int made_way = 0;
  for (int after_ms = 2'250; after_ms < 5'300; after_ms += 100) {
    INFO(after_ms);
    const Fleet fleet(cut_at(after_ms));
    const Result broken = exchange(fleet, by_apply);
    INFO(broken.err);
    CHECK_FALSE(contains(broken.err, "was not finished"));
    if (broken.status == 0 || places(fleet)[1] != 125) {
      continue;
    }
    CHECK_FALSE(contains(broken.err, "node 11 is as it was"));
    const bool is_said = contains(broken.err, "node 11 has made way for others: it is saved as "
                                              "node 125, and has not got node ID 12 yet") ||
                         contains(broken.err, "SAVE");
    CHECK(is_said);
    made_way += contains(broken.err, "made way for others: it is saved as") ? 1 : 0;
    CHECK(exchange(fleet, by_apply).status == 0);
    CHECK(places(fleet) == std::map<int, int>{{1, 12}, {2, 13}, {3, 11}});
  }
  CHECK(made_way > 3);
}

TEST_CASE("an erase that was to keep the IDs and breaks off keeps them when it is repeated") {
  int broken_off = 0;
  for (int after_ms = 1'330; after_ms < 2'250; after_ms += 40) {
    const Fleet fleet(cut_at(after_ms));
    const Arguments erase{"erase", "-n", "11,12", "--keep-ids", "--save", "-y"};
    const Result first = fleet.run(erase);
    INFO(after_ms << " ms: " << first.err);
    for (int times = 0; fleet.run({"scan", "--listen", "1"}).status == 3 && times < 20; ++times) {
      // until the interface is back
    }
    broken_off += first.status != 0 && fleet.ram("11", "static_node_id") == 0 ? 1 : 0;
    const Result again = fleet.run(erase);
    INFO(again.out << again.err);
    CHECK(again.status == 0);
    for (const auto* id : {"11", "12"}) {
      CHECK(fleet.rom(id, "static_node_id") == std::stoi(id));
      CHECK(fleet.rom(id, "servo_id") == std::stoi(id) - 10);
    }
  }
  CHECK(broken_off > 0);
}

TEST_CASE("an erase that was to keep IDs which another tool has saved as 0 asks whether they are") {
  int lost = 0;
  for (int after_ms = 1'330; after_ms < 2'250 && lost < 3; after_ms += 40) {
    const Fleet fleet(cut_at(after_ms));
    const Arguments erase{"erase", "-n", "serial:1", "--keep-ids", "--save", "-y"};
    const Result first = fleet.run(erase);
    INFO(after_ms << " ms: " << first.err);
    for (int times = 0; fleet.run({"scan", "--listen", "1"}).status == 3 && times < 20; ++times) {
      // until the interface is back
    }
    if (fleet.ram("11", "static_node_id") != 0) {
      continue;
    }
    ++lost;
    const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
    REQUIRE(fleet.run({"save", "-n", "11", "-y"}, other).status == 0);
    const Result again = fleet.run(erase);
    INFO(again.out << again.err);
    CHECK(again.status == 1);
    CHECK(contains(again.err, "whether 0 is meant is not known"));
    CHECK(contains(again.err, "servo_id=1 static_node_id=11 --save"));
    REQUIRE(fleet.run({"set", "-n", "serial:1", "servo_id=1", "static_node_id=11", "--save", "-y"})
                .status == 0);
    CHECK(fleet.run(erase).status == 0);
    CHECK(fleet.rom("11", "servo_id") == 1);
  }
  CHECK(lost > 0);
}

TEST_CASE("one that waits on a temporary ID, and loses its ROM there, is not told as saved") {
  Scene scene;
  scene
      .servo("BLA21-28U-A0", 12,
             {{"serial_number", 1}, {"behaviour", {{"first_node_status", "50ms"}}}})
      .servo(
          "BLA21-12U-A0", 38,
          {{"serial_number", 2}, {"faults", {{"ignore_opcodes", 3}, {"no_actuator_status", true}}}})
      .event(1, "rom_error", "3440ms");
  const Fleet fleet(scene);
  const Document file{
      {"schema", "blactl-fleet/1"},
      {"servos",
       {{{"name", "a"}, {"match", {{"serial_number", 1}}}, {"set", {{"static_node_id", 38}}}},
        {{"name", "b"}, {"match", {{"serial_number", 2}}}, {"set", {{"static_node_id", 12}}}}}}};
  const Result applied = fleet.apply(file, {"--json"});
  INFO(applied.out << applied.err);
  CHECK(applied.status == 6);
  const auto first = json(applied.out)["nodes"][0];
  CHECK(first["node_id_after"] == 125);
  CHECK(first["saved"] == false);
  CHECK(first["changes"][0]["after"].is_null());
}

TEST_CASE("what a restart has shown to be in ROM is told where the interface then goes") {
  int shown = 0;
  for (int at_ms = 1'200; at_ms < 3'000; at_ms += 20) {
    INFO("cut at " << at_ms << " ms");
    Scene scene;
    scene.servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"ram", {{"smoothing", "off"}}}})
        .clients("cut", std::to_string(at_ms) + "ms")
        .clients("joined", std::to_string(at_ms + 300) + "ms");
    const Fleet fleet(scene);
    const Result applied = fleet.apply(
        {{"schema", "blactl-fleet/1"},
         {"servos",
          {{{"name", "a"}, {"match", {{"serial_number", 1}}}, {"set", {{"smoothing", "off"}}}}}}},
        {"--json"});
    INFO(applied.out << applied.err);
    const auto nodes = json(applied.out)["nodes"];
    if (applied.status == 0 || nodes.empty() || nodes[0]["changes"].empty() ||
        nodes[0]["changes"][0]["after"] != 1) {
      continue;
    }
    ++shown;
    CHECK(nodes[0]["changes"][0]["status"] == "mismatch");
    CHECK_FALSE(contains(applied.err, "is as it was"));
  }
  CHECK(shown > 0);
}
