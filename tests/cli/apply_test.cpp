// apply: servos are brought to a fleet file, and the simulator tells what their ROM holds.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <algorithm>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

using Words = std::vector<std::string>;

} // namespace

TEST_CASE("apply brings every servo to the file: RAM, ROM, and diff agrees") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  for (auto& entry : document["servos"]) {
    entry["set"]["angle_limit_cw"] = "45.0deg";
    entry["set"]["smoothing"] = "off";
  }
  const Result applied = fleet.apply(document);
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(statuses(applied) == Words{"changed", "changed", "changed"});
  const auto said = json(applied.out);
  for (const auto& node : said["nodes"]) {
    CHECK(node["saved"] == true);
    CHECK(node["verified_after_restart"] == true);
    CHECK(node["node_id_after"] == node["node_id"]);
    for (const auto& change : node["changes"]) {
      CHECK(change["after"] == change["requested"]);
    }
  }
  CHECK(fleet.run({"diff", fleet.file(document)}).status == 0);
  CHECK(fleet.rom("11", "angle_limit_cw") == 450);
  CHECK(fleet.rom_writes() == 3);
}

TEST_CASE("what is as in the file already is restarted to see its ROM, and not written") {
  Fleet fleet(three_servos());
  const Result applied = fleet.apply(fleet.exported());
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(statuses(applied) == Words{"unchanged", "unchanged", "unchanged"});
  CHECK(json(applied.out)["nodes"][0]["verified_after_restart"] == true);
  CHECK(json(applied.out)["nodes"][0]["saved"] == false);
  const Result trusted = fleet.apply(fleet.exported(), {"--trust-ram"});
  CHECK(trusted.status == 0);
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("export | apply - changes nothing") {
  Fleet fleet(three_servos());
  const Result exported = fleet.run({"export"});
  REQUIRE(exported.status == 0);
  const Result applied = fleet.run({"apply", "-", "-y", "--json"}, {.stdin_text = exported.out});
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(statuses(applied) == Words{"unchanged", "unchanged", "unchanged"});
  CHECK(fleet.run({"diff", "-"}, {.stdin_text = exported.out}).status == 0);
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("a file that RAM agrees with and ROM does not is written to ROM") {
  Fleet fleet(three_servos());
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=45deg"}).status == 0);
  const Result applied = fleet.apply(fleet.exported());
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(statuses(applied) == Words{"changed", "unchanged", "unchanged"});
  CHECK(json(applied.out)["nodes"][0]["saved"] == true);
  CHECK(fleet.rom("11", "angle_limit_cw") == 450);
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("apply --dry-run says what would be done, and does nothing") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][1]["set"]["smoothing"] = "off";
  const Result planned = fleet.apply(document, {"--dry-run"});
  CHECK(planned.status == 8);
  CHECK(statuses(planned) == Words{"different", "different", "different"});
  CHECK(json(planned.out)["nodes"][0]["action"] == "restart");
  CHECK(json(planned.out)["nodes"][1]["action"] == "write");
  const Result text = fleet.run({"apply", fleet.file(document), "--dry-run"});
  CHECK(contains(text.out, "would change 1 of 30 settings, then save"));
  CHECK(contains(text.out, "smoothing"));
  CHECK(contains(text.out, "It would ask before:\nThis can move the shaft"));
  CHECK(fleet.run({"diff", fleet.file(document)}).status == 8);
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("apply --dry-run lists the servos in the order of the file") {
  const Fleet fleet(three_servos());
  Document document = fleet.exported();
  std::ranges::reverse(document["servos"]);
  std::vector<int> ids;
  const auto planned = ordered_json(fleet.apply(document, {"--dry-run"}).out);
  for (const auto& node : planned["nodes"]) {
    ids.push_back(node["node_id"]);
  }
  CHECK(ids == std::vector{13, 12, 11});
  const Result text = fleet.run({"apply", fleet.file(document), "--dry-run"});
  INFO(text.out);
  CHECK(text.out.find("node 13:") < text.out.find("node 12:"));
  CHECK(text.out.find("node 12:") < text.out.find("node 11:"));
}

TEST_CASE("apply --no-save writes RAM only") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"]["smoothing"] = "off";
  const Result applied = fleet.apply(document, {"--no-save"});
  CHECK(applied.status == 0);
  CHECK(statuses(applied) == Words{"changed", "unchanged", "unchanged"});
  CHECK(json(applied.out)["nodes"][0]["saved"] == false);
  CHECK(statuses(fleet.apply(document, {"--no-save"})) ==
        Words{"unchanged", "unchanged", "unchanged"});
  CHECK(fleet.rom("11", "smoothing") == 1);
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("servos exchange their node IDs and servo IDs in one apply") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  for (const auto* id : {"static_node_id", "servo_id"}) {
    std::swap(document["servos"][0]["set"][id], document["servos"][1]["set"][id]);
  }
  const Result applied = fleet.apply(document);
  INFO(applied.err);
  CHECK(applied.status == 0);
  const auto nodes = json(applied.out)["nodes"];
  CHECK(nodes[0]["node_id_after"] == 12);
  CHECK(nodes[1]["node_id_after"] == 11);
  CHECK(fleet.run({"diff", fleet.file(document)}).status == 0);
  CHECK(fleet.rom_writes() == 3); // one made way
}

TEST_CASE("an ID that comes in between is not told as the one that is wanted") {
  Scene scene;
  scene.servo("BLA21-12U-AB", 11, {{"servo_id", 1}, {"faults", {{"stays", true}}}});
  scene.servo("BLA21-12U-AB", 12, {{"servo_id", 2}});
  const Fleet fleet(scene);
  Document document = fleet.exported();
  std::swap(document["servos"][0]["set"]["static_node_id"],
            document["servos"][1]["set"]["static_node_id"]);
  const auto told = [&] {
    const Result applied = fleet.apply(document);
    CHECK(applied.status != 0);
    const auto nodes = json(applied.out)["nodes"];
    for (const auto& change : nodes[0]["changes"]) {
      if (change["address"] == "0x46") {
        return change;
      }
    }
    return nlohmann::json();
  };
  CHECK(told()["status"] == "mismatch");
  const auto again = told(); // it holds that ID in RAM already
  CHECK(again["status"] == "planned");
  CHECK(again["requested"] == 12);
}

TEST_CASE("what the table promises to a servo with a static node ID is in nobody's way") {
  const Fleet fleet(three_servos());
  const Document document = fleet.exported();
  const std::string unit = document["servos"][1]["match"]["unique_id"];
  const std::string entries = nlohmann::json{{"schema", "blactl-allocations/1"},
                                             {"entries", {{{"unique_id", unit}, {"node_id", 30}}}}}
                                  .dump();
  const Result imported = fleet.run({"alloc", "--import", fleet.bench().file("t.json", entries)});
  INFO(imported.err);
  REQUIRE(imported.status == 0);
  Document changed = document;
  changed["servos"][0]["set"]["static_node_id"] = 30;
  const Result applied = fleet.apply(changed);
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(json(applied.out)["nodes"][0]["node_id_after"] == 30);
}

TEST_CASE(
    "a static node ID that only RAM has is saved: the servo leaves where another one shall be") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  REQUIRE(fleet.run({"set", "-n", "12", "static_node_id=40"}).status == 0);
  document["servos"][0]["set"]["static_node_id"] = 12;
  document["servos"][1]["set"]["static_node_id"] = 40;
  const Result planned = fleet.apply(document, {"--dry-run"});
  CHECK(json(planned.out)["nodes"][1]["action"] == "save");
  const Result applied = fleet.apply(document, {"--trust-ram"});
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(json(applied.out)["nodes"][0]["node_id_after"] == 12);
  CHECK(json(applied.out)["nodes"][1]["node_id_after"] == 40);
  CHECK(fleet.run({"diff", fleet.file(document)}).status == 0);
  CHECK(fleet.rom_writes() == 2);
}

TEST_CASE("a servo that is missing stops all before the first write, unless -n narrows") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"]["smoothing"] = "off";
  document["servos"][2]["match"] = {{"serial_number", 4711}};
  const Result refused = fleet.apply(document);
  CHECK(refused.status == 4);
  CHECK(codes(refused) == Words{"not_found"});
  CHECK(contains(refused.err, "serial_number 4711"));
  CHECK(fleet.apply(document, {"-n", "all"}).status == 4);
  CHECK(fleet.run({"diff", fleet.file(document), "-n", "all"}).status == 8);
  const Result narrowed = fleet.apply(document, {"-n", "11"});
  INFO(narrowed.err);
  CHECK(narrowed.status == 0);
  CHECK(statuses(narrowed).front() == "changed");
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("--entry gives an entry to a servo that it does not mean") {
  Fleet fleet(three_servos().servo("BLA21-12U-AB", 20));
  Document document = fleet.exported();
  document["servos"][0]["name"] = "left aileron";
  document["servos"][0]["set"] = {{"smoothing", "off"}, {"servo_id", 77}};
  const Result given = fleet.apply(document, {"--entry", "left aileron", "-n", "20"});
  INFO(given.err);
  CHECK(given.status == 0);
  CHECK(json(given.out)["nodes"][0]["name"] == "left aileron");
  CHECK(fleet.rom("20", "servo_id") == 77);
  check_error(fleet.apply(document, {"--entry", "rudder", "-n", "20"}), 2, "usage", "rudder");
  check_error(fleet.apply(document, {"--entry", "left aileron", "-n", "11,20"}), 2, "usage",
              "one servo");
}

TEST_CASE("one servo that refuses stops all before the first write") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"]["smoothing"] = "off";
  document["servos"][1]["set"]["servo_id"] = document["servos"][0]["set"]["servo_id"];
  const Result refused = fleet.apply(document);
  CHECK(refused.status == 2); // of the file
  document["servos"].erase(0);
  const Result doubled = fleet.apply(document);
  CHECK(doubled.status == 9);
  CHECK(codes(doubled) == Words{"duplicate_servo_id"});
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("a servo that fails stops itself only") {
  Fleet fleet(three_servos().servo("BLA21-12U-AB", 20, {{"faults", {{"return_delay", "600s"}}}}));
  Document document = fleet.exported();
  for (auto& entry : document["servos"]) {
    entry["set"]["smoothing"] = "off";
  }
  const Result applied = fleet.apply(document);
  CHECK(applied.status == 6);
  CHECK(statuses(applied) == Words{"changed", "changed", "changed", "failed"});
  CHECK(codes(applied) == Words{"not_back"});
  const auto last = json(applied.out)["nodes"][3];
  CHECK(last["saved"] == false);
  CHECK(last["verified_after_restart"] == false);
}

TEST_CASE("apply takes a parameter file for one servo, and says when there are several") {
  const Fleet fleet(three_servos());
  const std::string file = fleet.params("0x22,1\n0x38,450\n0x51,1\n");
  check_error(fleet.run({"apply", file, "-y"}), 2, "usage", "nodes 11, 12, 13");
  const Result applied = fleet.run({"apply", file, "-y", "--json", "-n", "12"});
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(contains(applied.err, "0x51"));
  CHECK(statuses(applied) == Words{"changed"});
  CHECK(fleet.rom("12", "angle_limit_cw") == 450);
}

TEST_CASE("a plan that was kept is carried out as it stands") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][1]["set"]["smoothing"] = "off";
  const Result planned = fleet.apply(document, {"--dry-run"});
  REQUIRE(planned.status == 8);
  const std::string plan = fleet.plan(ordered_json(planned.out));
  const Result shown = fleet.run({"apply", "--plan", plan, "--dry-run", "--json"});
  CHECK(json(shown.out)["nodes"] == json(planned.out)["nodes"]);
  const Result done = fleet.run({"apply", "--plan", plan, "-y", "--json"});
  INFO(done.err);
  CHECK(done.status == 0);
  CHECK(statuses(done) == Words{"unchanged", "changed", "unchanged"});
  CHECK(fleet.rom("12", "smoothing") == 0);
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("a plan says itself what is saved") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"]["smoothing"] = "off";
  const Result planned = fleet.apply(document, {"--dry-run", "--no-save", "-n", "11"});
  const std::string plan = fleet.plan(ordered_json(planned.out));
  check_error(fleet.run({"apply", "--plan", plan, "--no-save"}), 2, "usage", "--no-save");
  CHECK(fleet.run({"apply", "--plan", plan, "-y"}).status == 0);
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("a plan of yesterday is refused where something has changed since, and says what") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"]["smoothing"] = "off";
  document["servos"][2]["set"]["smoothing"] = "off";
  const Result planned = fleet.apply(document, {"--dry-run"});
  const std::string plan = fleet.plan(ordered_json(planned.out));
  REQUIRE(fleet.run({"set", "-n", "13", "angle_limit_cw=45.0deg"}).status == 0);
  const Result refused = fleet.run({"apply", "--plan", plan, "-y"});
  check_error(refused, 9, "stale_plan", "node 13");
  CHECK(contains(refused.err, "angle_limit_cw was 179.9 deg, is 45.0 deg"));
  CHECK(fleet.run({"apply", "--plan", plan, "-y", "-n", "11"}).status == 0);
  const Result again = fleet.run({"apply", "--plan", plan, "-y", "-n", "11"});
  check_error(again, 9, "stale_plan", "smoothing was on, is off");
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("what is no plan, or was changed into none, is refused with all its faults") {
  const Fleet fleet(three_servos());
  const Document document = fleet.exported();
  check_error(fleet.run({"apply", "--plan", fleet.file(document)}), 2, "bad_file", "/schema");
  Document plan = ordered_json(fleet.apply(document, {"--dry-run"}).out);
  plan["nodes"][0]["unique_id"] = nullptr;
  plan["nodes"][1]["changes"][0]["requested"] = 70000;
  plan["nodes"][2]["changes"][0]["address"] = "0x49";
  plan["nodes"][2]["unique_id"] = plan["nodes"][1]["unique_id"];
  const Result refused = fleet.run({"apply", "--plan", fleet.plan(plan)});
  CHECK(refused.status == 2);
  for (const char* place :
       {"/nodes/0/unique_id", "/nodes/1/changes/0", "/nodes/2/changes/0", ": /nodes/2: "}) {
    INFO(place);
    CHECK(contains(refused.err, place));
  }
  plan = ordered_json(fleet.apply(document, {"--dry-run", "-n", "77"}).out);
  check_error(fleet.run({"apply", "--plan", fleet.plan(plan)}), 2, "bad_file", "errors");
}

TEST_CASE("--events tells each stage of each servo, and what came of it") {
  const Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][1]["set"]["smoothing"] = "off";
  document["servos"][2]["set"]["static_node_id"] = 40;
  const std::string events = fleet.file_name("events.jsonl");
  const Result done = fleet.apply(document, {"--events", events});
  REQUIRE(done.status == 0);
  CHECK(std::ranges::any_of(json_lines(content(events)), [](const auto& line) {
    return line["stage"] == "end" && line["node_id"] == 40; // where it is now
  }));
  std::vector<std::string> told;
  for (const auto& line : json_lines(content(events))) {
    CHECK(line["time"].is_number());
    CHECK(line["unique_id"].get<std::string>().size() == 32);
    if (line["node_id"] == 12) {
      told.push_back(line["stage"].get<std::string>() + ' ' + line["status"].get<std::string>());
    }
  }
  CHECK(told ==
        Words{"plan different", "write running", "save running", "read running", "end changed"});
  check_error(fleet.apply(document, {"--events", "/nowhere/events"}), 1, "io", "/nowhere/events");
  check_error(fleet.apply(document, {"--events", "-"}), 2, "usage", "need a file");
}

TEST_CASE("events that cannot be written are told of, and what was done stays done") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][1]["set"]["smoothing"] = "off";
  const Result done = fleet.apply(document, {"--events", "/dev/full"});
  CHECK(codes(done) == Words{"io"});
  CHECK(statuses(done)[1] == "changed");
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("--fail-fast: one servo that fails keeps the others from being saved") {
  Fleet fleet(Scene()
                  .servo("BLA21-12U-AB", 11, {{"faults", {{"refuse_opcodes", true}}}})
                  .servo("BLA21-12U-AB", 12)
                  .servo("BLA21-12U-AB", 13));
  Document document = fleet.exported();
  for (auto& servo : document["servos"]) {
    servo["set"] = {{"smoothing", "off"}, {"angle_limit_cw", "45.0deg"}};
  }
  const Result stopped = fleet.apply(document, {"--fail-fast", "--stagger", "1"});
  CHECK(statuses(stopped) == Words{"failed", "failed", "failed"});
  CHECK(contains(stopped.err, "node 12 was written in RAM and is not saved"));
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("a servo that comes to another one's former node ID is told apart from it") {
  // What is heard first says nothing of the unit.
  const nlohmann::json late = {{"behaviour", {{"first_node_status", "700ms"}}}};
  const Fleet fleet(Scene()
                        .servo("BLA21-12U-AB", 11, late)
                        .servo("BLA21-12U-AB", 12, late)
                        .servo("BLA21-12U-AB", 13, late));
  Document document = fleet.exported();
  for (std::size_t i = 0; i < 3; ++i) {
    document["servos"][i]["set"] = {{"static_node_id", 11 + (i + 1) % 3}};
  }
  const Result rotated = fleet.apply(document);
  INFO(rotated.err);
  CHECK(rotated.status == 0);
  CHECK(statuses(rotated) == Words{"changed", "changed", "changed"});
}

TEST_CASE("a second apply writes nothing and restarts nothing") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"]["smoothing"] = "off";
  REQUIRE(fleet.apply(document).status == 0); // one is saved, the others are restarted
  const Result again = fleet.apply(document);
  INFO(again.err);
  CHECK(again.status == 0);
  CHECK(statuses(again) == Words{"unchanged", "unchanged", "unchanged"});
  const auto said = json(again.out);
  for (const auto& node : said["nodes"]) {
    CHECK(node["verified_after_restart"] == true);
    CHECK(node["duration_s"] == 0);
  }
  CHECK(fleet.apply(document, {"--dry-run"}).status == 0);
  CHECK(fleet.count("restart") == 3);
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("after a power cycle apply restarts to see what ROM holds, and writes none") {
  Fleet fleet(Scene()
                  .servo("BLA21-12U-AB", 11, {{"serial_number", 7}, {"servo_id", 1}})
                  .event(7, "power_off", "100s")
                  .event(7, "power_on", "101s"));
  const Document document = fleet.exported();
  REQUIRE(fleet.apply(document).status == 0);
  REQUIRE(fleet.run({"trace", "--duration", "120", "-q"}).status == 0);
  CHECK(fleet.apply(document, {"--dry-run"}).status == 8);
  const Result third = fleet.apply(document);
  INFO(third.err);
  CHECK(third.status == 0);
  CHECK(statuses(third) == Words{"unchanged"});
  CHECK(json(third.out)["nodes"][0]["duration_s"] > 0);
  CHECK(fleet.rom_writes() == 0);
}

TEST_CASE("what is set in RAM after a proof is told from ROM, and saved without a restart before") {
  Fleet fleet(three_servos());
  REQUIRE(fleet.apply(fleet.exported()).status == 0);
  REQUIRE(fleet.run({"set", "-n", "11", "smoothing=off"}).status == 0);
  const Document document = fleet.exported();
  const Result planned = fleet.apply(document, {"--dry-run"});
  CHECK(json(planned.out)["nodes"][0]["action"] == "save");
  CHECK(json(planned.out)["nodes"][1]["action"] == "nothing");
  const Result applied = fleet.apply(document);
  INFO(applied.err);
  CHECK(statuses(applied) == Words{"changed", "unchanged", "unchanged"});
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("apply refuses where it cannot record what servos hold, unless --no-snapshot") {
  Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"]["smoothing"] = "off";
  const auto [name, content] = GENERATE(
      std::pair("", "in the place of the folder"), std::pair("snapshots.db", "no database"),
      std::pair("proofs.db", "no database"), std::pair("allocations.db", "no database"));
  INFO(name);
  const Options options = fleet.broken_state(name, content);
  const Result refused = fleet.apply(document, {}, options);
  INFO(refused.err);
  CHECK(refused.status == 1);
  CHECK(codes(refused) == Words{"state"});
  CHECK(contains(refused.err, "--no-snapshot"));
  CHECK(fleet.apply(document, {"--dry-run"}, options).status == 8);
  const Result applied = fleet.apply(document, {"--no-snapshot"}, options);
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(statuses(applied).front() == "changed");
  CHECK(contains(applied.err, name == std::string("allocations.db")
                                  ? "the node IDs given now are not kept"
                                  : "this change is not recorded"));
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("apply warns of what SAVE keeps beside what the file names, and of what a restart ends") {
  const Fleet fleet(three_servos());
  Document document = fleet.exported();
  for (auto& servo : document["servos"]) {
    servo["set"] = {{"smoothing", "off"}};
  }
  REQUIRE(fleet.apply(document).status == 0);
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=70.0deg"}).status == 0);
  document["servos"][0]["set"]["smoothing"] = "on";
  const Result planned = fleet.apply(document, {"--dry-run"});
  CHECK(json(planned.out)["nodes"][0]["warnings"][0]["code"] == "unnamed_saved");
  const Result applied = fleet.run({"apply", fleet.file(document), "-y"});
  CHECK(contains(applied.err, "angle_limit_cw is 70.0 deg in RAM and 179.9 deg in ROM"));
}

TEST_CASE("what a proving restart takes from RAM is told") {
  const Fleet fleet(three_servos());
  Document document = fleet.exported();
  document["servos"][0]["set"] = {{"smoothing", "on"}};
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=70.0deg"}).status == 0);
  const Result proven = fleet.apply(document, {"-n", "11"});
  CHECK(statuses(proven)[0] == "unchanged");
  CHECK(json(proven.out)["nodes"][0]["warnings"][0]["code"] == "unnamed_lost");
}

TEST_CASE("a plan for another firmware is stale, and one whose names contradict is none") {
  const Fleet fleet(three_servos());
  Document plan = ordered_json(fleet.apply(fleet.exported(), {"--dry-run"}).out);
  plan["nodes"][0]["firmware_version"] = 1300;
  check_error(fleet.run({"apply", "--plan", fleet.plan(plan)}), 9, "stale_plan", "firmware 1300");
  plan["nodes"][1]["changes"][0]["name"] = "smoothing";
  check_error(fleet.run({"apply", "--plan", fleet.plan(plan)}), 2, "bad_file",
              "/nodes/1/changes/0");
}

TEST_CASE("events replace no file that has other content, and no record of blactl's") {
  const Fleet fleet(three_servos());
  const Document document = fleet.exported();
  const std::string other = fleet.bench().file("other.json", R"({"schema": "blactl-fleet/1"})");
  check_error(fleet.apply(document, {"--events", other}), 2, "usage", "has no events of blactl");
  CHECK(content(other) == R"({"schema": "blactl-fleet/1"})");
  const std::string events = fleet.file_name("events.jsonl");
  for (int time = 0; time < 2; ++time) { // its like is replaced
    CHECK(fleet.apply(document, {"--events", events}).status == 0);
  }
  check_error(fleet.run({"characterize", "-n", "11", other, "-y", "--json"}), 2, "usage",
              "is no facts file");
}

TEST_CASE("events are not written over the file that is applied") {
  const Fleet fleet(three_servos());
  const std::string file = fleet.file(fleet.exported());
  const std::string before = content(file);
  check_error(fleet.run({"apply", file, "--events", file, "-y"}), 2, "usage", "which is applied");
  CHECK(content(file) == before);
}

TEST_CASE("--record is not written over a file that the command reads or writes") {
  const Fleet fleet(three_servos());
  const std::string file = fleet.file(fleet.exported());
  const std::string before = content(file);
  for (const Arguments& command :
       {Arguments{"apply", file, "-y"}, Arguments{"diff", file},
        Arguments{"apply", "--plan", file, "-y"}, Arguments{"export", file}}) {
    Arguments words = command;
    words.insert(words.end(), {"--record", file});
    check_error(fleet.run(words), 2, "usage", "that is the file of");
    CHECK(content(file) == before);
  }
}

TEST_CASE("a plan gives no node IDs") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 0, {{"serial_number", 7}}));
  const Document document = {
      {"schema", "blactl-fleet/1"},
      {"servos",
       {{{"name", "new"}, {"match", {{"serial_number", 7}}}, {"set", {{"smoothing", "off"}}}}}}};
  const Result planned = fleet.apply(document, {"--dry-run"});
  CHECK(codes(planned) == Words{"not_found"});
  CHECK(contains(planned.err, "a unit waits for a node ID: unique ID "));
  CHECK(json(fleet.run({"alloc", "--list", "--json"}).out)["entries"].empty());
  CHECK(fleet.apply(document).status == 0);
}

TEST_CASE("a dry run tells which servo waits for a node ID, and goes on with the others") {
  const std::string waits = "a1b20000000000000000000000000001";
  Scene scene = three_servos();
  scene.servo("BLA21-12U-AB", 0, {{"serial_number", 7}, {"unique_id", waits}});
  Fleet fleet(scene);
  Document document = fleet.exported();
  document["servos"].push_back(
      {{"name", "new"}, {"match", {{"unique_id", waits}}}, {"set", {{"smoothing", "off"}}}});
  const Result planned = fleet.apply(document, {"--dry-run"});
  INFO(planned.err << planned.out);
  CHECK(planned.status == 8);
  CHECK(codes(planned).empty());
  CHECK(contains(planned.err, "'new' waits for a node ID: it would get a free one first, then be "
                              "compared in 1 settings"));
  CHECK(statuses(planned) == Words{"different", "different", "different", "missing"});
  CHECK(json(fleet.run({"alloc", "--list", "--json"}).out)["entries"].empty());
  REQUIRE(fleet.apply(document).status == 0);
  CHECK(fleet.ram("uid:" + waits, "smoothing") == 0);
}

TEST_CASE("an entry of one unit means it also when it holds what the entry sets") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 11, {{"serial_number", 7}, {"servo_id", 1}}));
  const Document document = {{"schema", "blactl-fleet/1"},
                             {"servos",
                              {{{"name", "left"},
                                {"match", {{"serial_number", 7}, {"servo_id", 1}, {"node_id", 11}}},
                                {"set", {{"servo_id", 3}, {"static_node_id", 21}}}}}}};
  CHECK(statuses(fleet.apply(document)) == Words{"changed"});
  CHECK(statuses(fleet.apply(document)) == Words{"unchanged"});
}

TEST_CASE("a servo that has not said who it is may be meant by an entry for several servos") {
  const Fleet fleet(
      Scene()
          .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
          .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"faults", {{"mute", true}}}}));
  const Document models{
      {"schema", "blactl-fleet/1"},
      {"servos",
       {{{"name", "all"}, {"match", {{"model", "BLA21"}}}, {"set", {{"angle_p_gain", 70}}}}}}};
  const Result applied = fleet.apply(models);
  INFO(applied.out << applied.err);
  CHECK(applied.status != 0);
  CHECK(contains(applied.err, "node 12 is on the bus, but has not said who it is: all may mean"));
  CHECK(fleet.ram("11", "angle_p_gain") != 70);
  const std::string file = fleet.file(models);
  for (const Arguments& more : {Arguments{}, Arguments{"-n", "model:BLA21"}}) {
    Arguments diff{"diff", file};
    diff.insert(diff.end(), more.begin(), more.end());
    const Result compared = fleet.run(diff);
    INFO(compared.out << compared.err);
    CHECK(compared.status != 0);
    CHECK(compared.status != 8);
  }
}

TEST_CASE("a servo that does not say who it is may be the one that a parameter file is for") {
  const Fleet fleet(three_servos().servo("BLA21-12U-AB", 20, {{"faults", {{"mute", true}}}}));
  check_error(fleet.run({"apply", fleet.params("0x22 0\n"), "-y"}), 2, "usage", "11, 12, 13, 20");
  const std::string file = fleet.file(Fleet(three_servos()).exported());
  CHECK(statuses(fleet.run({"diff", file, "--json"})).back() == "extra");
}

TEST_CASE(
    "a ROM that cannot be read is written, also where the servo's initial values are wished") {
  const Fleet fleet(Scene().servo(
      "BLA21-12U-AB", 11, {{"serial_number", 7}, {"faults", {{"power_loss_in_save", "10ms"}}}}));
  REQUIRE(fleet.run({"save", "-n", "11", "-y"}).status != 0);
  const Document document = {
      {"schema", "blactl-fleet/1"},
      {"servos",
       {{{"name", "left"}, {"match", {{"serial_number", 7}}}, {"set", {{"smoothing", "on"}}}}}}};
  CHECK(codes(fleet.apply(document)) == Words{"rom_unread"});
  REQUIRE(fleet.run({"restart", "-n", "all", "-y"}).status == 0);
  CHECK(codes(fleet.apply(document)) == Words{"not_confirmed"});
  const Result healed = fleet.apply(document, {"--overwrite-rom"});
  INFO(healed.err);
  CHECK(healed.status == 0);
  CHECK(json(healed.out)["nodes"][0]["saved"] == true);
  CHECK(fleet.run({"faults", "-n", "11"}).status == 0);
  CHECK(statuses(fleet.apply(document)) == Words{"unchanged"});
}

TEST_CASE("a unit that shares its node ID is not missing") {
  const nlohmann::json one = {{"unique_id", "00112233445566778899aabbccddee01"}};
  const nlohmann::json other = {{"unique_id", "00112233445566778899aabbccddee02"}};
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 11, one).servo("BLA21-12U-AB", 11, other));
  const Document document = {{"schema", "blactl-fleet/1"},
                             {"servos",
                              {{{"name", "left"},
                                {"match", {{"unique_id", one["unique_id"]}}},
                                {"set", {{"smoothing", "off"}}}}}}};
  CHECK(codes(fleet.apply(document)) == Words{"duplicate_node_id"});
}

TEST_CASE("a proof of the last simulation proves nothing in the next one") {
  const Bench bench;
  const std::string scenario = Scene().servo("BLA21-12U-AB", 11).write(bench);
  const std::string file = bench.file("fleet.json", R"({"schema": "blactl-fleet/1", "servos": [
      {"name": "a", "match": {"node_id": 11}, "set": {"smoothing": "off"}}]})");
  const Arguments apply{"-i", "sim:", "apply", file, "-y", "--json"};
  {
    Background sim(bench, {"sim", scenario, "--json", "--clock", "virtual"});
    CHECK(statuses(bench.run(apply)) == Words{"changed"});
    CHECK(statuses(bench.run(apply)) == Words{"unchanged"});
    (void)sim.stop();
  }
  const Background sim(bench, {"sim", scenario, "--json", "--clock", "virtual"});
  REQUIRE(bench.run({"-i", "sim:", "set", "-n", "11", "smoothing=off", "-y"}).status == 0);
  CHECK(statuses(bench.run(apply)) == Words{"changed"});
}

TEST_CASE("apply gives a node ID to the missing servo, and to no other that asks") {
  const std::string unit = "0000000000000000000000000000beef";
  Fleet fleet(Scene().servo("BLA21-12U-AB", 0).servo("BLA21-12U-AB", 0, {{"unique_id", unit}}));
  const auto applied = [&](const Document& match) {
    return fleet.apply(
        {{"schema", "blactl-fleet/1"},
         {"servos", {{{"name", "a"}, {"match", match}, {"set", {{"smoothing", "off"}}}}}}});
  };
  CHECK(applied({{"unique_id", unit}}).status == 0);
  CHECK(json(fleet.run({"scan", "--json"}).out)["nodes"].size() == 1);
  CHECK(applied({{"serial_number", 1}}).status == 4); // it may be anyone
  CHECK(json(fleet.run({"scan", "--json"}).out)["nodes"].size() == 2);
}

TEST_CASE("the output is switched off before limits change, and on after them") {
  const auto order = [](const char* torque) {
    const Bench bench;
    const std::string log = (bench.folder() / "set.log").string();
    const char* before = std::string(torque) == "torque_output=on" ? "off" : "on";
    const Scene scene = Scene().servo("BLA21-12U-AB", 11,
                                      {{"ram", {{"0x20", std::string(before) == "off" ? 1 : 0}}}});
    const Result set = scene.run(bench, {"set", "-n", "11", "angle_limit_cw=90deg", torque,
                                         "angle_limit_ccw=-90deg", "-y", "--record", log});
    INFO(set.out << set.err);
    CHECK(set.status == 0);
    Words names;
    for (const auto& line : json_lines(bench.run({"trace", log, "--json"}).out)) {
      const bool is_write = line.value("kind", "") == "request" && line.contains("fields") &&
                            line["fields"].contains("value") &&
                            !line["fields"]["value"].contains("empty");
      if (is_write) {
        names.push_back(line["fields"]["name"]);
      }
    }
    return names;
  };
  CHECK(order("torque_output=off") == Words{"0x20", "0x38", "0x39"});
  CHECK(order("torque_output=on") == Words{"0x38", "0x39", "0x20"});
}

TEST_CASE("a servo that the command itself has given an ID is not left out") {
  const Fleet fleet(Scene()
                        .servo("BLA21-12U-AB", 11, {{"servo_id", 1}, {"serial_number", 1}})
                        .servo("BLA21-12U-AB", 0, {{"servo_id", 2}, {"serial_number", 2}}));
  const Result applied = fleet.apply(
      {{"schema", "blactl-fleet/1"},
       {"servos",
        {{{"name", "a"}, {"match", {{"serial_number", 1}}}, {"set", {{"smoothing", "off"}}}},
         {{"name", "b"}, {"match", {{"serial_number", 2}}}, {"set", {{"smoothing", "off"}}}}}}});
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK_FALSE(contains(applied.err, "left out"));
}

TEST_CASE("0x36 in deg is not held where ROM counts it in rpm, whatever number it holds") {
  const Fleet fleet(Scene().servo(
      "BLA21-12U-AB", 11,
      {{"serial_number", 1}, {"rom", {{"pwm_mode", "speed"}, {"pwm_output_range", "700raw"}}}}));
  const bool is_proven = GENERATE(false, true);
  if (is_proven) {
    REQUIRE(fleet.run({"save", "-n", "11", "-y"}).status == 0);
  }
  REQUIRE(fleet.run({"set", "-n", "11", "pwm_mode=angle", "-y"}).status == 0);
  const Result applied = fleet.apply({{"schema", "blactl-fleet/1"},
                                      {"servos",
                                       {{{"name", "1"},
                                         {"match", {{"serial_number", 1}}},
                                         {"set", {{"pwm_output_range", "70deg"}}}}}}});
  INFO(applied.err);
  if (is_proven) { // it is saved with the rest of RAM, which is told
    CHECK(applied.status == 0);
    CHECK(contains(applied.err, "pwm_mode"));
    CHECK(fleet.rom("11", "pwm_mode") == 0);
  } else {
    CHECK(applied.status == 1);
    CHECK(codes(applied) == std::vector<std::string>{"state"});
  }
}

TEST_CASE("a node ID that apply itself has brought up is no newcomer before its second round") {
  const Fleet fleet(three_servos());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  const auto does = [&](const Arguments& command) {
    const Result result = fleet.run(command, other);
    INFO(result.err);
    REQUIRE(result.status == 0);
  };
  does({"set", "-n", "11", "static_node_id=44", "-y"});
  does({"set", "-n", "12", "smoothing=off", "-y"});
  const Result applied = fleet.apply(fleet.exported());
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(fleet.rom("44", "static_node_id") == 44);
  CHECK(fleet.rom("12", "smoothing") == 0);
}
