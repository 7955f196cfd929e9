// Units that their unique ID does not tell from others: copied, or never given one.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <string>
#include <vector>

using namespace blactl::test;

namespace {

/// `silent`: they send NodeStatus alone.
Scene twins(bool silent = false) {
  const std::string copied = "abababababababababababababababab";
  const nlohmann::json faults{{"no_actuator_status", silent}};
  return Scene()
      .servo("BLA21-12U-AB", 10, {{"unique_id", copied}, {"servo_id", 1}, {"faults", faults}})
      .servo("BLA21-12U-AB", 11, {{"unique_id", copied}, {"servo_id", 2}, {"faults", faults}})
      .servo("BLA21-12U-AB", 12, {{"servo_id", 3}});
}

constexpr const char* two_of_one =
    "nodes 10, 11 have the same unique ID abababababababababababababababab: blactl would take one "
    "for the other";

/// All zeros, or all ones.
Scene one_without(char digit) {
  return Scene().servo("BLA21-12U-AB", 10, {{"unique_id", std::string(32, digit)}});
}

std::vector<int> node_ids(const Result& result) {
  std::vector<int> ids;
  const auto document = json(result.out);
  for (const auto& node : document["nodes"]) {
    ids.push_back(node["node_id"]);
  }
  return ids;
}

} // namespace

TEST_CASE("scan lists both of two units with one unique ID, and says so") {
  const Result scanned = twins().run({"scan", "--json"});
  CHECK(node_ids(scanned) == std::vector{10, 11, 12});
  CHECK(scanned.status == 9);
  CHECK(codes(scanned) == std::vector<std::string>{"duplicate_unique_id"});
  const auto conflict = json(scanned.out)["conflicts"][0];
  CHECK(conflict["code"] == "duplicate_unique_id");
  CHECK(conflict["node_ids"] == nlohmann::json{10, 11});
  CHECK(contains(scanned.err, two_of_one));
}

TEST_CASE("doctor finds two units with one unique ID") {
  const Result examined = twins().run({"doctor", "--json"});
  CHECK(examined.status == 8);
  CHECK(contains(examined.out, R"("code": "duplicate_unique_id")"));
}

TEST_CASE("no command changes one of two units with one unique ID, and the third is free") {
  const auto command = GENERATE(
      Arguments{"set", "-n", "10", "smoothing=off", "-y"},
      Arguments{"set", "-n", "11", "smoothing=off", "--save", "-y"},
      Arguments{"save", "-n", "10,12", "-y"}, Arguments{"restart", "-n", "10,11", "-y"},
      Arguments{"erase", "-n", "11", "-y"}, Arguments{"alloc", "--static", "-n", "10"},
      Arguments{"pwm-config", "-n", "10", "--output", "90deg", "-y"},
      Arguments{"command", "-n", "10", "angle=10deg", "-y"}, Arguments{"characterize", "-n", "11"});
  const bool silent = GENERATE(false, true);
  INFO(command.front() << (silent ? ", silent but for NodeStatus" : ""));
  Fleet fleet(twins(silent));
  const Result refused = fleet.run(command);
  CHECK(refused.status == 9);
  CHECK(contains(refused.err, two_of_one));
  CHECK(fleet.run({"set", "-n", "12", "smoothing=off", "--save", "-y"}).status == 0);
  CHECK(fleet.count("restart") == 1);
}

TEST_CASE("apply does not take the proof of one unit for that of its copy") {
  Fleet fleet(twins());
  auto document = fleet.exported();
  document["servos"].erase(document["servos"].begin());
  document["servos"][0]["match"] = {{"node_id", 11}};
  document["servos"][0]["set"].erase("static_node_id");
  const Result applied = fleet.apply(document, {"-n", "11"});
  CHECK(codes(applied) == std::vector<std::string>{"duplicate_unique_id"});
}

TEST_CASE("an entry that means a unit by the unique ID that two have is a conflict") {
  const Bench bench;
  const nlohmann::json file{{"schema", "blactl-fleet/1"},
                            {"servos",
                             {{{"name", "a"},
                               {"match", {{"unique_id", "abababababababababababababababab"}}},
                               {"set", {{"smoothing", "off"}}}}}}};
  const std::string path = bench.file("fleet.json", file.dump());
  for (const Arguments& command : {Arguments{"apply", path, "-y"}, {"diff", path}}) {
    const Result result = twins().run(bench, command);
    INFO(result.err);
    CHECK(result.status == 9);
    CHECK(contains(result.err, two_of_one));
  }
}

TEST_CASE("reading goes on beside a unique ID of zeros or ones, with a note; writing does not") {
  const char digit = GENERATE('0', 'f');
  const std::string note = "node 10 has no unique ID of its own (" + std::string(32, digit) + ")";
  const auto command = GENERATE(Arguments{"get", "-n", "10", "smoothing"}, Arguments{"export"});
  const Result read = one_without(digit).run(command);
  CHECK(read.status == 0);
  CHECK(contains(read.err, note));
  const Result scanned = one_without(digit).run({"scan", "--json"});
  CHECK(scanned.status == 0);
  CHECK(contains(json(scanned.out)["nodes"][0]["warnings"][0].get<std::string>(), note));
  CHECK(contains(one_without(digit).run({"doctor", "--json"}).out, "no_unique_id"));
  check_error(one_without(digit).run({"set", "-n", "10", "smoothing=off", "--save", "-y"}), 9,
              "duplicate_unique_id", note);
}

TEST_CASE("a unit without a unique ID of its own gets no node ID") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 0, {{"unique_id", std::string(32, '0')}})
                          .servo("BLA15-12U-A0", 0);
  const Result given = scene.run({"alloc", "--once", "--json"});
  CHECK(given.status != 0);
  CHECK(contains(given.out, R"("assigned":1)"));
}

TEST_CASE("a servo that comes back under another node ID is no copy of itself") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 10));
  for (const char* id : {"20", "10", "20"}) {
    CHECK(fleet.run({"set", "-n", "all", std::string("static_node_id=") + id, "--save", "-y"})
              .status == 0);
  }
  CHECK(fleet.run({"scan"}).status == 0);
}

TEST_CASE("a unit that asks, and whose unique ID another has already, gets no node ID") {
  const nlohmann::json same = {{"unique_id", "abababababababababababababababab"}};
  const Scene scene = Scene().servo("BLA21-12U-AB", 11, same).servo("BLA21-12U-AB", 0, same);
  const Result given = scene.run({"alloc", "--once", "--json"});
  CHECK(codes(given) == std::vector<std::string>{"duplicate_unique_id"});
  CHECK(contains(given.out, R"("assigned":0)"));
}

TEST_CASE("a servo is not restarted while a unit with its unique ID asks for a node ID") {
  const nlohmann::json same = {{"unique_id", "abababababababababababababababab"}};
  Fleet fleet(Scene().servo("BLA21-12U-AB", 11, same).servo("BLA21-12U-AB", 0, same));
  const auto command = GENERATE(Arguments{"restart", "-n", "11", "-y"},
                                Arguments{"set", "-n", "11", "smoothing=off", "--save", "-y"});
  check_error(fleet.run(command), 9, "duplicate_unique_id",
              "node 11 and a unit that asks for a node ID have the same unique ID");
  CHECK(fleet.count("restart") == 0);
  CHECK(fleet.run({"set", "-n", "11", "smoothing=off", "-y"}).status == 0);
}

TEST_CASE("the history of one unit is not that of another with its unique ID") {
  const std::string copied = "abababababababababababababababab";
  const Fleet fleet(
      Scene()
          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"unique_id", copied}})
          .servo(
              "BLA21-12U-AB", 11,
              {{"serial_number", 2}, {"unique_id", copied}, {"rom", {{"angle_limit_cw", "60deg"}}}})
          .event(1, "power_off", "60s")
          .joins(2, "80s"));
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=45deg", "--save", "-y"}).status == 0);
  REQUIRE(fleet.run({"monitor", "-n", "11", "--duration", "90"}).status == 0);
  check_error(fleet.run({"undo", "-y"}), 9, "duplicate_unique_id", "serial number: 2, not 1");
  CHECK(codes(fleet.run({"undo", "-n", "11", "-y"})) == std::vector<std::string>{"not_found"});
  CHECK(fleet.ram("11", "angle_limit_cw") == 600);
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=50deg", "-y"}).status == 0);
  CHECK(fleet.run({"undo", "-n", "11", "-y"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 600);
}

TEST_CASE("a unit that asks, and whose unique ID only begins like that of a servo, is another") {
  Fleet fleet(Scene()
                  .servo("BLA21-12U-AB", 11, {{"unique_id", "abababababababababababababababab"}})
                  .servo("BLA21-12U-AB", 0, {{"unique_id", "abababababab00000000000000000000"}}));
  CHECK(fleet.run({"restart", "-n", "11", "-y"}).status == 0);
}
