// Settings that nobody named and that stand in RAM only: what a SAVE makes permanent, and what a
// restart loses, is said before; undo brings it back.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <string>

using namespace blactl::test;

namespace {

Scene one_servo() {
  return Scene().servo("BLA21-12U-AB", 11, {{"serial_number", 7}});
}

Document wishes(const char* parameter, const char* value) {
  return {{"schema", "blactl-fleet/1"},
          {"servos",
           {{{"name", "left"}, {"match", {{"serial_number", 7}}}, {"set", {{parameter, value}}}}}}};
}

/// Yesterday's trial.
void try_out(const Fleet& fleet) {
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=70.0deg"}).status == 0);
}

nlohmann::json warning(const Result& result) {
  return json(result.out)["nodes"][0]["warnings"][0];
}

} // namespace

TEST_CASE("what SAVE makes permanent beside what was named is said before, from the record alone") {
  const auto command = GENERATE(
      Arguments{"set", "-n", "11", "smoothing=off", "--save"}, Arguments{"save", "-n", "11"},
      Arguments{"pwm-config", "-n", "11", "--neutral", "1500us", "--save"});
  const Fleet fleet(one_servo());
  try_out(fleet);
  Arguments whole = command;
  whole.insert(whole.end(), {"-y", "--json"});
  const Result saved = fleet.run(whole);
  INFO(saved.err);
  CHECK(contains(saved.err, "angle_limit_cw is 70.0 deg since a change in RAM only, and was 179.9 "
                            "deg before: SAVE keeps"));
  CHECK(warning(saved)["code"] == "unnamed_saved");
}

TEST_CASE(
    "a static node ID that the servo would be on if ROM had it is reported without a record") {
  const Fleet fleet(one_servo());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  REQUIRE(fleet.run({"set", "-n", "11", "static_node_id=20", "-y"}, other).status == 0);
  const Result saved = fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y", "--json"});
  INFO(saved.err);
  CHECK(saved.status == 0);
  CHECK(warning(saved)["code"] == "unnamed_saved");
  CHECK(contains(saved.err, "static_node_id is 20 in RAM only: SAVE keeps all of RAM"));
}

TEST_CASE("what another node was just heard to write is said before SAVE keeps it") {
  const nlohmann::json write{
      {"at", "300ms"}, {"to", 11}, {"order", "write"}, {"address", 0x38}, {"value", 450}};
  Scene scene = one_servo();
  scene.foreign(91, {{"orders", nlohmann::json::array({write})}});
  const bool is_saved = GENERATE(true, false);
  const Fleet fleet(scene);
  const Result done = fleet.run(is_saved ? Arguments{"save", "-n", "11", "-y", "--json"}
                                         : Arguments{"restart", "-n", "11", "-y", "--json"});
  INFO(done.err);
  CHECK(done.status == 0);
  CHECK(warning(done)["code"] == (is_saved ? "unnamed_saved" : "unnamed_lost"));
  CHECK(contains(done.err, "angle_limit_cw is 45.0 deg, and node 91 wrote to it a moment ago: "));
  CHECK(fleet.ram("11", "angle_limit_cw") == (is_saved ? 450 : 1799));
}

TEST_CASE("what another node writes while a restart waits for its turn is told, too") {
  const auto write = [](const char* at, int address, int value) {
    return nlohmann::json{
        {"at", at}, {"to", 12}, {"order", "write"}, {"address", address}, {"value", value}};
  };
  Scene scene = one_servo();
  scene.servo("BLA21-12U-AB", 12, {{"serial_number", 8}});
  scene.foreign(91, {{"orders", nlohmann::json::array({write("3000ms", 0x38, 450)})}});
  const Fleet fleet(scene);
  const Result done = fleet.run({"restart", "-n", "11,12", "--stagger", "4", "-y", "--json"});
  INFO(done.out << done.err);
  CHECK(done.status == 0);
  const auto document = json(done.out);
  const auto warnings = document["nodes"][1]["warnings"];
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0]["code"] == "unnamed_lost");
  CHECK_FALSE(document["nodes"][0].contains("warnings"));
  CHECK(contains(done.err, "angle_limit_cw is 45.0 deg, and node 91 wrote to it a moment ago: "));
  CHECK(fleet.ram("12", "angle_limit_cw") == 1799);
}

TEST_CASE("what the proving restart of apply has lost is told though ROM is written after it") {
  const Fleet fleet(one_servo());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  for (const Arguments& command : {Arguments{"set", "-n", "11", "smoothing=off", "--save", "-y"},
                                   Arguments{"set", "-n", "11", "smoothing=on", "-y"},
                                   Arguments{"set", "-n", "11", "angle_p_gain=9", "-y"}}) {
    REQUIRE(fleet.run(command, other).status == 0);
  }
  const Result applied = fleet.apply(wishes("smoothing", "on"));
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(json(applied.out)["nodes"][0]["saved"] == true);
  CHECK(warning(applied)["code"] == "unnamed_lost");
  CHECK(contains(applied.err, "angle_p_gain was 9 in RAM only: the restart has brought back"));
}

TEST_CASE("an erase that keeps the IDs says before that it saves those that RAM alone holds") {
  const Fleet fleet(one_servo());
  REQUIRE(fleet.run({"set", "-n", "11", "servo_id=7", "-y"}).status == 0);
  const Result erased = fleet.run({"erase", "-n", "11", "--keep-ids", "--save", "-y", "--json"});
  INFO(erased.err);
  CHECK(erased.status == 0);
  CHECK(warning(erased)["code"] == "unnamed_saved");
  CHECK(contains(erased.err, "servo_id is 7 since a change in RAM only"));
}

TEST_CASE("what characterize has put back is in RAM only as before, though the servo restarted") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  REQUIRE(fleet.run({"characterize", "-n", "11", "-y"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 700);
  const Result saved = fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y", "--json"});
  CHECK(warning(saved)["code"] == "unnamed_saved");
  CHECK(contains(saved.err, "angle_limit_cw is 70.0 deg since a change in RAM only"));
}

TEST_CASE("a restart says before what it loses, records it, and undo brings it back to RAM") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  const Result restarted = fleet.run({"restart", "-n", "11", "-y", "--json"});
  CHECK(restarted.status == 0);
  CHECK(contains(restarted.err, "angle_limit_cw is 70.0 deg since a change in RAM only, and was "
                                "179.9 deg before: the restart takes it back"));
  CHECK(warning(restarted)["code"] == "unnamed_lost");
  CHECK(fleet.ram("11", "angle_limit_cw") == 1799);
  CHECK(fleet.run({"undo", "-y"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 700);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
}

TEST_CASE("the proving restart of apply says before what it loses, in the plan too") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  const Document same = wishes("smoothing", "on");
  const Result planned = fleet.apply(same, {"--dry-run"});
  CHECK(warning(planned)["code"] == "unnamed_lost");
  const Result proven = fleet.apply(same);
  CHECK(statuses(proven) == std::vector<std::string>{"unchanged"});
  CHECK(contains(proven.err, "the restart takes it back"));
  CHECK(fleet.ram("11", "angle_limit_cw") == 1799);
  CHECK(fleet.run({"undo", "-y"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 700);
}

TEST_CASE("a proving restart that loses nothing leaves nothing to undo") {
  const Fleet fleet(one_servo());
  REQUIRE(fleet.run({"set", "-n", "11", "reverse=on", "--save", "-y"}).status == 0);
  REQUIRE(fleet.run({"set", "-n", "11", "reverse=off", "--save", "-y"}).status == 0);
  const Options without_proof{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  CHECK(statuses(fleet.apply(wishes("smoothing", "on"), {}, without_proof)) ==
        std::vector<std::string>{"unchanged"});
  const Result list = fleet.run({"undo", "--list", "--json"}, without_proof);
  CHECK(json(list.out)["snapshots"].empty());
}

TEST_CASE("nothing is said of what a restart has ended already") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  REQUIRE(fleet.run({"restart", "-n", "11", "-y"}).status == 0);
  const Result saved = fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y", "--json"});
  CHECK(saved.status == 0);
  CHECK(json(saved.out)["nodes"][0]["warnings"].empty());
}

TEST_CASE("a trial that was taken back is not in RAM only, whatever has restarted since") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  SECTION("by undo") {
    REQUIRE(fleet.run({"undo", "-y"}).status == 0);
  }
  SECTION("by hand") {
    REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=179.9deg"}).status == 0);
  }
  REQUIRE(fleet.run({"restart", "-n", "11", "-y"}).status == 0);
  const Result saved = fleet.run({"save", "-n", "11", "-y", "--json"});
  INFO(saved.err);
  CHECK(saved.status == 0);
  CHECK(json(saved.out)["nodes"][0]["warnings"].empty());
  CHECK(fleet.run({"undo", "-y"}).status == 0);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799); // it never held anything else
}

TEST_CASE("a plan is stale once a setting has changed that it does not name") {
  const Fleet fleet(one_servo());
  const Document plan = ordered_json(fleet.apply(wishes("smoothing", "off"), {"--dry-run"}).out);
  try_out(fleet);
  check_error(fleet.run({"apply", "--plan", fleet.plan(plan), "-y"}), 9, "stale_plan",
              "a setting that the plan does not name has changed");
}

TEST_CASE("what a restart took is not what a later SAVE made permanent") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  REQUIRE(fleet.run({"restart", "-n", "11", "-y"}).status == 0);
  REQUIRE(fleet.run({"save", "-n", "11", "-y"}).status == 0);
  CHECK(fleet.run({"undo", "-y"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 700);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
}

TEST_CASE("undo of an apply does not make permanent what its proving restart took from RAM") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  REQUIRE(fleet.run({"set", "-n", "11", "smoothing=off"}).status == 0);
  REQUIRE(statuses(fleet.apply(wishes("smoothing", "off"))) == std::vector<std::string>{"changed"});
  REQUIRE(fleet.rom("11", "smoothing") == 0);
  CHECK(fleet.run({"undo", "-n", "11", "-y"}).status == 0);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
  CHECK(fleet.rom("11", "smoothing") == 1);
}

TEST_CASE("a change in RAM that a later SAVE made permanent is taken back from ROM too") {
  const Fleet fleet(one_servo());
  try_out(fleet);
  REQUIRE(fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y"}).status == 0);
  const auto snapshots = json(fleet.run({"undo", "--list", "--json"}).out)["snapshots"];
  REQUIRE(snapshots.size() == 2);
  CHECK(fleet.run({"undo", "-y"}).status == 0);
  CHECK(fleet.rom("11", "smoothing") == 1);
}
