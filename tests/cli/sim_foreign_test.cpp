#include "catch.hpp"
#include "scene.hpp"

#include <map>

using namespace blactl::test;

namespace {

/// What flies with servos.
Scene aircraft() {
  return Scene()
      .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
      .servo("BLA21-12U-AB", 0)
      .foreign(10, {{"kind", "autopilot"},
                    {"allocates", true},
                    {"commands", {{"servo_ids", {1}}, {"type", 1}, {"value", 0.1}}}})
      .foreign(20, {{"kind", "gnss"}})
      .foreign(30, {{"kind", "esc"}, {"index", 2}});
}

} // namespace

TEST_CASE("scan tells servos from the other nodes of an aircraft, and who allocates") {
  const auto scan = json(aircraft().run({"scan", "--json", "--listen", "10"}).out);
  std::map<int, std::string> others;
  std::vector<int> servos;
  for (const auto& node : scan["nodes"]) {
    if (node["model"].is_null()) {
      others[node["node_id"]] = node["info"]["name"];
    } else {
      servos.push_back(node["node_id"]);
    }
  }
  CHECK(servos == std::vector<int>{11, 125});
  CHECK(others == std::map<int, std::string>{{10, "org.example.autopilot"},
                                             {20, "org.example.gnss"},
                                             {30, "org.example.esc"}});
  CHECK(scan["allocators"].size() == 1);
  CHECK(scan["commanders"].size() == 1);
}

TEST_CASE("trace decodes what the nodes of an aircraft send without an error") {
  const auto lines = json_lines(aircraft().run({"trace", "--duration", "3", "--json"}).out);
  std::map<std::string, std::size_t> types;
  for (const auto& line : lines) {
    CHECK_FALSE(line.contains("error"));
    if (line.contains("type")) {
      ++types[line["type"]];
    }
  }
  CHECK(types["uavcan.equipment.gnss.Fix2"] >= 13);
  CHECK(types["uavcan.equipment.gnss.Auxiliary"] >= 2);
  CHECK(types["uavcan.equipment.esc.Status"] >= 145);
  CHECK(types["uavcan.equipment.safety.ArmingStatus"] >= 2);
}

TEST_CASE("a speed controller that has parameters is still no servo") {
  const Result result = aircraft().run({"get", "-n", "30", "0x38"});
  CHECK(result.status == 4);
  CHECK(contains(result.err, "node 30 (org.example.esc) is not a BLA servo"));
}

TEST_CASE("a servo is read beside a node that fills nine tenths of the bus") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"servo_id", 7}})
                          .foreign(40, {{"kind", "babbler"}, {"load", 0.9}, {"priority", 31}});
  const Result result = scene.run({"get", "-n", "11", "servo_id"});
  CHECK(result.status == 0);
  CHECK(contains(result.out, "servo_id   7"));
}
