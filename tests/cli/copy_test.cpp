// Copying: the recipe of one servo, or its parameter file, is applied to others.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <algorithm>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

using Words = std::vector<std::string>;

constexpr int source = 11;
constexpr int last = 18;
const std::string copies = "12-18";

/// Eight servos of one model, the first one set up. `odd`: the model of the last one.
Fleet eight(const std::string& odd = "BLA21-12U-AB", const nlohmann::json& more = {}) {
  Scene scene;
  for (int id = source; id <= last; ++id) {
    nlohmann::json keys = {{"servo_id", id - 10}, {"serial_number", id}};
    if (id == last) {
      keys.update(more.is_null() ? nlohmann::json::object() : more);
    }
    scene.servo(id == last ? odd : "BLA21-12U-AB", id, keys);
  }
  return Fleet(scene);
}

std::string recipe_of_source(const Fleet& fleet) {
  REQUIRE(fleet.run({"set", "-n", "11", "smoothing=off", "timeout_time=700ms", "--save", "-y"})
              .status == 0);
  const Result recipe = fleet.run({"export", "-n", "11", "--recipe"});
  REQUIRE(recipe.status == 0);
  return recipe.out;
}

Result copy(const Fleet& fleet, const std::string& recipe, const Arguments& more) {
  Arguments arguments{"apply", "-", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return fleet.run(arguments, {.stdin_text = recipe});
}

const std::string head = R"({"schema": "blactl-recipe/1", "name": "wing", "model": )";

std::string counting(const std::string& model = "BLA21") {
  return head + '"' + model + R"(", "set": {"smoothing": "off",
      "servo_id": {"first": 1, "last": 8}}})";
}

} // namespace

TEST_CASE("the settings of one servo are copied to seven others, whose IDs stay") {
  Fleet fleet = eight();
  const std::string recipe = recipe_of_source(fleet);
  const Result compared = fleet.run({"diff", "-", "-n", copies, "--json"}, {.stdin_text = recipe});
  CHECK(compared.status == 8);
  CHECK(json(compared.out)["counts"]["differences"] == 14);
  const Result copied = copy(fleet, recipe, {"-n", copies, "-y"});
  INFO(copied.err);
  CHECK(copied.status == 0);
  CHECK(statuses(copied) == Words(7, "changed"));
  const auto told = json(copied.out);
  for (const auto& node : told["nodes"]) {
    CHECK(node["name"] == nullptr);
    CHECK(node["verified_after_restart"] == true);
    CHECK(node["node_id_after"] == node["node_id"]);
    for (const auto& change : node["changes"]) {
      CHECK(change["name"] != "servo_id");
      CHECK(change["name"] != "static_node_id");
    }
  }
  CHECK(fleet.run({"diff", "-", "-n", "all"}, {.stdin_text = recipe}).status == 0);
  for (int id = source; id <= last; ++id) {
    CHECK(fleet.ram(std::to_string(id), "servo_id") == id - 10);
  }
  CHECK(fleet.rom("15", "timeout_time") == 700);
  CHECK(fleet.ram("15", "static_node_id") == 15);
  CHECK(fleet.rom_writes() == 8); // and the first one itself
}

TEST_CASE("undo takes a copy back from all servos") {
  Fleet fleet = eight();
  const std::string recipe = recipe_of_source(fleet);
  REQUIRE(copy(fleet, recipe, {"-n", copies, "-y"}).status == 0);
  const Result undone = fleet.run({"undo", "-y", "--json"});
  INFO(undone.err);
  CHECK(undone.status == 0);
  CHECK(statuses(undone) == Words(7, "changed"));
  CHECK(fleet.rom("18", "smoothing") == 1);
  CHECK(fleet.ram("11", "smoothing") == 0);
}

TEST_CASE("one servo of another model stops the copy before the first write") {
  Fleet fleet = eight("BLA15-12U-A0");
  const std::string recipe = recipe_of_source(fleet);
  check_error(copy(fleet, recipe, {"-n", copies, "-y"}), 9, "model_mismatch",
              "node 18: it is a BLA15-12U-A0, the recipe is for BLA21-12U-AB");
  CHECK(fleet.ram("12", "smoothing") == 1);
  const Result compared = fleet.run({"diff", "-", "-n", "11,18", "--json"}, {.stdin_text = recipe});
  CHECK(compared.status == 6);
  CHECK(statuses(compared) == Words{"unchanged", "failed"});
  CHECK(copy(fleet, recipe, {"-n", "model:BLA21", "-y"}).status == 0);
  CHECK(fleet.rom_writes() == 7);
}

TEST_CASE("a firmware that is older than the recipe needs stops the copy, and all are named") {
  Fleet fleet = eight();
  const std::string recipe =
      head + R"("BLA21", "firmware_min": 1401, "set": {"smoothing": "off"}})";
  const Result refused = copy(fleet, recipe, {"-n", "12,13", "-y"});
  CHECK(refused.status == 9);
  CHECK(codes(refused) == Words{"firmware_too_old", "firmware_too_old"});
  CHECK(contains(refused.err, "node 12: its firmware is 1.400, the recipe needs 1.401"));
  CHECK(contains(refused.err, "node 13: "));
  const Result japanese = copy(fleet, recipe, {"-n", "12", "-y", "--lang", "ja"});
  CHECK(contains(japanese.err, "レシピの条件: 1.401 以降"));
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("a value that one of the models refuses is written to none") {
  Fleet fleet = eight("BLA21-12U-A0");
  const std::string pwm = head + R"("BLA21-12U", "set": {"pwm_neutral": "1500us"}})";
  check_error(copy(fleet, pwm, {"-n", copies, "-y"}), 2, "unsupported", "node 18");
  CHECK(fleet.ram("12", "pwm_neutral") == 1520);
  CHECK(copy(fleet, pwm, {"-n", "12-17", "-y"}).status == 0);
  const std::string current = head + R"("BLA21", "set": {"overcurrent_limit": "100.0A"}})";
  CHECK(copy(fleet, current, {"-n", copies, "-y"}).status == 2);
  CHECK(fleet.rom_writes() == 6);
}

TEST_CASE("one servo that refuses its SAVE stops itself only") {
  const Fleet fleet = eight("BLA21-12U-AB", {{"faults", {{"refuse_opcodes", true}}}});
  const std::string recipe = recipe_of_source(fleet);
  const Result copied = copy(fleet, recipe, {"-n", copies, "-y"});
  INFO(copied.err);
  CHECK(copied.status == 6);
  Words expected(6, "changed");
  expected.emplace_back("failed");
  CHECK(statuses(copied) == expected);
}

TEST_CASE("a recipe needs -n, and neither counters nor --entry") {
  Fleet fleet = eight();
  const std::string recipe = recipe_of_source(fleet);
  check_error(copy(fleet, recipe, {"-y"}), 2, "usage", "does not say which servos");
  check_error(fleet.run({"diff", "-"}, {.stdin_text = recipe}), 2, "usage",
              "does not say which servos");
  check_error(copy(fleet, recipe, {"-n", "12", "--entry", "wing", "-y"}), 2, "usage",
              "has no entries");
  check_error(copy(fleet, counting(), {"-n", "12", "-y"}), 2, "usage",
              "a production line: servo_id");
  check_error(fleet.run({"diff", "-", "-n", "12"}, {.stdin_text = counting()}), 2, "usage",
              "a production line: servo_id");
  const Result all = copy(fleet, counting(), {"--entry", "wing", "-y"});
  CHECK(all.status == 2);
  CHECK(codes(all) == Words{"usage", "usage", "usage"});
  check_error(fleet.run({"apply", fleet.params("0x22 0\n"), "-n", "12", "--entry", "x", "-y"}), 2,
              "usage", "has no entries");
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("an ID that a recipe gives is for one servo") {
  const Fleet fleet = eight();
  const std::string recipe = head + R"("BLA21", "set": {"servo_id": 40}})";
  check_error(copy(fleet, recipe, {"-n", "12-13", "-y"}), 2, "usage",
              "would give the same servo_id to 2 servos");
  CHECK(copy(fleet, recipe, {"-n", "12", "-y"}).status == 0);
  CHECK(fleet.rom("12", "servo_id") == 40);
}

TEST_CASE("a copy asks one question, and without a terminal it needs --yes") {
  Fleet fleet = eight();
  const std::string recipe = recipe_of_source(fleet);
  const Result refused = copy(fleet, recipe, {"-n", copies});
  check_error(refused, 7, "not_confirmed", "add --yes");
  CHECK(contains(refused.err, "node 18: "));
  CHECK(fleet.ram("12", "smoothing") == 1);
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("a servo of -n that is not there stops the copy") {
  Fleet fleet = eight();
  const std::string recipe = recipe_of_source(fleet);
  check_error(copy(fleet, recipe, {"-n", "12-19", "-y"}), 4, "not_found", "node 19");
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("with -n all a servo that does not say who it is stops the copy") {
  Fleet fleet = eight("BLA21-12U-AB", {{"faults", {{"mute", true}}}});
  const std::string recipe = recipe_of_source(fleet);
  const Result refused = copy(fleet, recipe, {"-n", "all", "-y"});
  CHECK(refused.status == 4);
  CHECK(contains(refused.err, "node 18"));
  const Result compared = fleet.run({"diff", "-", "-n", "all"}, {.stdin_text = recipe});
  CHECK(compared.status == 4);
  CHECK(contains(compared.err, "node 18"));
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("a copy is planned, kept, and carried out as it stands; later it is stale") {
  Fleet fleet = eight();
  const std::string recipe = recipe_of_source(fleet);
  const Result planned = copy(fleet, recipe, {"-n", copies, "--dry-run"});
  CHECK(planned.status == 8);
  CHECK(statuses(planned) == Words(7, "different"));
  CHECK(json(planned.out)["nodes"][0]["name"] == nullptr);
  const std::string plan = fleet.plan(ordered_json(planned.out));
  REQUIRE(fleet.run({"set", "-n", "13", "reverse=on", "-y"}).status == 0);
  check_error(fleet.run({"apply", "--plan", plan, "-y"}), 9, "stale_plan", "node 13");
  REQUIRE(fleet.run({"set", "-n", "13", "reverse=off", "-y"}).status == 0);
  const Result done = fleet.run({"apply", "--plan", plan, "-y", "--json"});
  INFO(done.err);
  CHECK(done.status == 0);
  Words expected(7, "changed");
  expected.emplace_back("extra"); // the first one: the plan does not mean it
  CHECK(statuses(done) == expected);
  CHECK(json(done.out)["nodes"][0]["name"] == nullptr);
  CHECK(fleet.rom_writes() == 8);
}

TEST_CASE("a copy may be in RAM only, and tells its events") {
  Fleet fleet = eight();
  const std::string recipe = recipe_of_source(fleet);
  const std::string events = fleet.file_name("events.jsonl");
  const Result copied =
      copy(fleet, recipe, {"-n", copies, "-y", "--no-save", "--fail-fast", "--events", events});
  INFO(copied.err);
  CHECK(copied.status == 0);
  CHECK(statuses(copied) == Words(7, "changed"));
  const auto lines = json_lines(content(events));
  CHECK(std::ranges::count_if(lines, [](const auto& line) { return line["stage"] == "end"; }) == 7);
  CHECK(fleet.rom("14", "smoothing") == 1);
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("a parameter file for several servos goes without its IDs, and says so") {
  const Fleet fleet = eight();
  const std::string file = fleet.params("0x22 0\n0x45 3\n0x46 13\n");
  check_error(fleet.run({"apply", file, "-y"}), 2, "usage", "and there are several");
  const Result compared = fleet.run({"diff", file, "-n", "12-14"});
  CHECK(compared.status == 8);
  CHECK(contains(compared.err, "left out, as the file is for several servos: servo_id, static_"));
  CHECK_FALSE(contains(compared.out, "static_node_id"));
  const Result applied = fleet.run({"apply", file, "-n", "12-14", "-y", "--json"});
  CHECK(applied.status == 0);
  CHECK(statuses(applied) == Words{"changed", "changed", "changed"});
  CHECK(contains(applied.err, "left out, as the file is for several servos: servo_id, static_"));
  CHECK(contains(fleet.run({"diff", file, "-n", "12-14", "--lang", "ja"}).err,
                 "複数のサーボが対象のため除外しました: servo_id, static_node_id"));
  CHECK(fleet.rom("12", "servo_id") == 2);
  CHECK(fleet.rom("12", "smoothing") == 0);
  const Result one = fleet.run({"diff", file, "-n", "12"});
  CHECK(contains(one.out, "static_node_id"));
  CHECK_FALSE(contains(one.err, "left out"));
}

TEST_CASE("a recipe is compared with a file of one servo") {
  const Bench bench;
  const std::string one = bench.file("one.json", head + R"("BLA21", "set": {"0x22": 0}})");
  const std::string other = bench.file("other.param", "0x22 1\n");
  CHECK(bench.run({"diff", one, one}).status == 0);
  CHECK(bench.run({"diff", one, other}).status == 8);
  const std::string many = bench.file("many.json", R"({"schema": "blactl-fleet/1", "servos": []})");
  check_error(bench.run({"diff", one, many}), 2, "usage", "is of one servo");
  check_error(bench.run({"diff", bench.file("c.json", counting()), other}), 2, "usage",
              "a production line: servo_id");
}

TEST_CASE("apply --check looks at the file alone, whichever it is") {
  const Bench bench;
  const auto check = [&](const std::string& file, const Arguments& more = {}) {
    Arguments arguments{"-i", "nosuchcan0", "apply", file, "--check"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return bench.run(arguments);
  };
  const std::string data = BLACTL_TEST_DATA;
  CHECK(check(data + "/fleets/eight.json").status == 0);
  CHECK(check(data + "/recipes/aileron.json").status == 0); // it has counters
  const Result params = check(data + "/params/gui_tool.parm");
  CHECK(params.status == 0);
  CHECK(contains(params.err, "skipped, as they are not settings"));
  const std::string recipe = bench.file("a.json", counting());
  CHECK(check(recipe).out == recipe + ": no faults (entries: 1, settings: 2)\n");
  CHECK(contains(check(recipe, {"--lang", "ja"}).out, "誤りなし (エントリ 1 件、設定 2 項目)"));
  const auto document = json(check(recipe, {"--json"}).out);
  CHECK(document["exit_status"] == 0);
  CHECK(document["nodes"].empty());
  CHECK(document["counts"]["entries"] == 1);
  const Result piped = bench.run({"apply", "-", "--check"}, {.stdin_text = counting()});
  CHECK(piped.status == 0);
  check_error(check(bench.file("x.json", counting("BLA99"))), 2, "bad_file",
              "/: there is no model 'BLA99'");
  CHECK(check(bench.folder() / "absent.json").status == 2);
}

TEST_CASE("apply --check tells the faults that apply tells, each with pointer and line") {
  const Bench bench;
  const std::string file = std::string(BLACTL_TEST_DATA) + "/faulty/fleet.json";
  const Result checked = bench.run({"-i", "nosuchcan0", "apply", file, "--check"});
  const Result applied = bench.run({"-i", "nosuchcan0", "apply", file});
  CHECK(checked.status == 2);
  CHECK(contains(checked.err, "fleet.json:3: /servos/0/set/angle_limit_cw: "));
  CHECK(checked.err == applied.err);
}

TEST_CASE("apply --check goes with nothing that needs a bus") {
  const Bench bench;
  const std::string file = bench.file("a.json", counting());
  for (const Arguments& more :
       {Arguments{"-n", "11"}, Arguments{"--dry-run"}, Arguments{"--plan"},
        Arguments{"--entry", "a"}, Arguments{"--no-save"}, Arguments{"--trust-ram"},
        Arguments{"--fail-fast"}, Arguments{"--events", "e.jsonl"}, Arguments{"--no-snapshot"},
        Arguments{"--wait", "3"}, Arguments{"--stagger", "1"}}) {
    Arguments arguments{"apply", file, "--check"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    check_error(bench.run(arguments), 2, "usage", more.front() + " has no meaning beside --check");
  }
  const Result two = bench.run({"apply", file, "--check", "--dry-run", "--plan"});
  CHECK(codes(two) == Words{"usage", "usage"});
}
