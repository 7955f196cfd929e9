// What can happen at a station (blactl(1), "blactl provision"): one test for each.

#include "catch.hpp"
#include "line.hpp"

#include <optional>
#include <set>
#include <string>

using namespace blactl::test;

namespace {

const std::string short_recipe = R"({
  "schema": "blactl-recipe/1", "name": "short", "model": "BLA21-12U-AB",
  "set": {"servo_id": {"first": 1, "last": 1}, "angle_limit_cw": "45.0deg"}
})";

Provisioned one(const nlohmann::json& faults, int node_id = 7) {
  return provision(
      line(
          {{.serial = 101, .from = 1, .to = 90, .node_id = node_id, .more = {{"faults", faults}}}}),
      {"--count", "1", "--idle-timeout", "100"});
}

} // namespace

TEST_CASE("a unit whose supply dips in the save fails, since its ROM cannot be read after that") {
  const auto* const dip = GENERATE("500us", "20ms", "49ms");
  const Provisioned run = provision(line({{.serial = 101,
                                           .from = 1,
                                           .to = 40,
                                           .node_id = 7,
                                           .more = {{"faults", {{"power_loss_in_save", dip}}}}},
                                          {.serial = 101, .from = 50, .to = 90}}),
                                    {"--count", "2", "--idle-timeout", "100"});
  INFO(dip << run.result.out << run.result.err);
  CHECK(run.told() == "fail mismatch; fail rom_unread");
  REQUIRE(run.records.size() == 2);
  CHECK(run.records[0]["parameter"] == "angle_limit_cw");
  CHECK_FALSE(contains(run.result.err, "blactl restart")); // nobody does that at a station
  CHECK(contains(run.result.err, "blactl erase"));
}

TEST_CASE("a unit that cannot read its ROM fails, and nothing is saved to it") {
  const Provisioned run = one({{"rom_unread_starts", 99}});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "fail rom_unread");
  CHECK(run.result.status == 9);
  REQUIRE(run.last["errors"].size() == 1);
  const std::string hint = run.last["errors"][0]["hint"];
  CHECK_FALSE(contains(hint, "overwrite-rom")); // no station has it
  CHECK(contains(hint, "blactl erase"));
  const std::string message = run.last["errors"][0]["message"];
  CHECK(contains(message, "serial number 101: ")); // many stand one below the other
  const std::string reason = run.records[0]["reason"];
  CHECK(contains(reason, "could not read its ROM"));
  CHECK(contains(run.result.err, "rom_unread"));
}

TEST_CASE("a unit that could not read its ROM is done when its next start can") {
  const Provisioned run = provision(line({{.serial = 101,
                                           .from = 1,
                                           .to = 20,
                                           .node_id = 7,
                                           .more = {{"faults", {{"rom_unread_starts", 2}}}}},
                                          {.serial = 101, .from = 30, .to = 60}}),
                                    {"--count", "2", "--idle-timeout", "100"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "fail rom_unread; pass 1 11");
}

TEST_CASE("a station never saves over a ROM that could not be read, whatever it is told") {
  const Scene scene = line({{.serial = 101,
                             .from = 1,
                             .to = 20,
                             .node_id = 7,
                             .more = {{"faults", {{"rom_unread_starts", 99}}}}}});
  const Provisioned run =
      provision(scene, {"--overwrite-rom", "--count", "1", "--idle-timeout", "60"});
  CHECK(run.records.empty());
  CHECK(run.result.status == 2);
}

TEST_CASE("a unit that answers nothing fails") {
  const Provisioned run = one({{"mute", true}});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "fail timeout");
  CHECK(run.result.status == 4);
}

TEST_CASE("a unit that does not return from its restart was taken off, as far as can be known") {
  const Provisioned run =
      provision(Scene().servo("BLA21-12U-AB", 7,
                              {{"serial_number", 101}, {"faults", {{"never_returns", true}}}}),
                {"--idle-timeout", "60"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "error not_back");
}

TEST_CASE("a unit that never settles is no pass") {
  const nlohmann::json faults =
      GENERATE(nlohmann::json{{"stays", true}}, nlohmann::json{{"refuse_opcodes", true}},
               nlohmann::json{{"ignore_opcodes", 99}}, nlohmann::json{{"rom_write_fails", true}});
  const Provisioned run = one(faults);
  INFO(faults << run.result.out << run.result.err);
  REQUIRE(run.records.size() == 1);
  CHECK(run.records[0]["verdict"] != "pass");
  CHECK_FALSE(run.records[0]["code"].is_null());
}

TEST_CASE("a warning or a failure bit is no pass, and the record tells which") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 60, .node_id = 7}})
                                        .world(101, {{"temperature", "120degC"}}, "1100ms"),
                                    {"--count", "1", "--idle-timeout", "100"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "fail faults");
  CHECK(contains(run.records[0]["faults"].get<std::string>(), "0x1A."));
}

TEST_CASE("a counter at its end is the station's error, and ends the run") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 30},
                                          {.serial = 102, .from = 40, .to = 70},
                                          {.serial = 103, .from = 80, .to = 110}}),
                                    {}, {}, short_recipe);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 0; error counter_end");
  CHECK(run.result.status == 6);
  CHECK(contains(run.result.err, "\"last\""));
}

TEST_CASE("a bus that is off goes on when it is back, with the same unit") {
  const std::string link = GENERATE("bus_off", "cut");
  const std::string at = GENERATE("500ms", "3s", "5s");
  INFO(link << " " << at);
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 60, .node_id = 7},
                                          {.serial = 101, .from = 70, .to = 120}})
                                        .clients(link, at)
                                        .clients("joined", "20s"),
                                    {"--count", "1", "--idle-timeout", "100"});
  INFO(run.result.out << run.result.err);
  REQUIRE_FALSE(run.records.empty());
  CHECK(run.records.back()["verdict"] == "pass");
  for (std::size_t i = 0; i + 1 < run.records.size(); ++i) {
    CHECK(run.records[i]["verdict"] == "error");
  }
}

TEST_CASE("nobody is told as gone while the bus is off") {
  const Bench bench;
  const std::string events = (bench.folder() / "events").string();
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 2.2, .node_id = 7},
                                          {.serial = 101, .from = 30, .to = 60}})
                                        .clients("bus_off", "1800ms"),
                                    {"--count", "1", "--idle-timeout", "60", "--events", events});
  INFO(run.result.out << run.result.err << content(events));
  CHECK(run.records.back()["verdict"] == "pass");
  CHECK(contains(content(events), "no_bus"));
  CHECK_FALSE(contains(content(events), "gone"));
}

TEST_CASE("an adapter that is lost is waited for, and its unit is done again") {
  const Bench bench;
  const std::string scenario = bench.file("real.json", R"({"schema": "blactl-scenario/1",
                       "servos": [{"model": "BLA21-12U-AB", "node_id": 7, "serial_number": 101}]})");
  std::optional<Background> sim(std::in_place, bench, Arguments{"sim", scenario});
  const std::string events = (bench.folder() / "events").string();
  Background station(bench,
                     {"-i", "sim:", "provision", bench.file("recipe.json", line_recipe), "-y",
                      "--json", "--count", "1", "--events", events},
                     {.terminal = true}, "do not take it off");
  sim->kill();
  station.expect("\"code\":\"interface\"");
  station.expect("connect the adapter again");
  sim.emplace(bench, Arguments{"sim", scenario});
  const Result run = station.wait();
  INFO(run.out << run.err);
  const auto records = json_lines(run.out);
  REQUIRE(records.size() == 3);
  CHECK(records[0]["verdict"] == "error");
  CHECK(records[1]["verdict"] == "pass");
  CHECK(run.status == 3);
  CHECK(contains(content(events), "\"event\":\"no_bus\""));
}

TEST_CASE("an adapter that is lost while nobody is there is waited for too") {
  const Bench bench;
  const std::string empty = bench.file("empty.json", R"({"schema": "blactl-scenario/1"})");
  const std::string full = bench.file("full.json", R"({"schema": "blactl-scenario/1",
                       "servos": [{"model": "BLA21-12U-AB", "node_id": 7, "serial_number": 101}]})");
  std::optional<Background> sim(std::in_place, bench, Arguments{"sim", empty});
  Background station(bench,
                     {"-i", "sim:", "provision", bench.file("recipe.json", line_recipe), "-y",
                      "--json", "--count", "1"},
                     {.terminal = true}, "connect a servo");
  sim->kill();
  station.expect("connect the adapter again");
  sim.emplace(bench, Arguments{"sim", full});
  const Result run = station.wait();
  INFO(run.out << run.err);
  CHECK(json_lines(run.out)[0]["verdict"] == "pass");
  CHECK(run.status == 0);
}

TEST_CASE("what cannot be recorded is no pass, and ends the run") {
  // no room from the beginning: nothing is begun
  const Bench bench;
  const Background sim(bench, {"sim", line({{.serial = 101, .from = 1, .to = 3000}}).write(bench)});
  const Result run = bench.run({"-i", "sim:", "provision", bench.file("recipe.json", line_recipe),
                                "-y", "--json", "--count", "1"},
                               {.env = {{"BLACTL_STATE_DIR", "/proc/state"}}});
  INFO(run.out << run.err);
  CHECK(run.status != 0);
  CHECK_FALSE(contains(run.out, "\"pass\""));
  CHECK(contains(run.out, "\"hint\":\""));
}

#ifndef BLACTL_SANITIZED

TEST_CASE("a clock in trouble is noted in every record that has no other reason") {
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30}});
  const auto on_clock = [&](const char* state) {
    return provision(scene, {"--count", "1"},
                     {.env = {{"LD_PRELOAD", BLACTL_LINE_CALLS}, {"FAKED_CLOCK", state}}});
  };
  const Provisioned run = on_clock("5");
  CHECK(run.told() == "pass 1 11");
  CHECK(run.records[0]["reason"] == "the clock of this machine is not synchronised");
  CHECK(contains(run.result.err, "not synchronised"));
  const Provisioned fine = on_clock("0");
  CHECK(fine.records[0]["reason"].is_null());
  CHECK_FALSE(contains(fine.result.err, "not synchronised"));
}

TEST_CASE("a disk that is full at any write never lets a unit pass without its record") {
  const int at = GENERATE(1, 3, 6, 10, 14, 18, 22, 28, 34);
  const Bench bench;
  const Background sim(bench, {"sim", line({{.serial = 101, .from = 1, .to = 3000}}).write(bench)});
  const Arguments arguments{"-i", "sim:",   "provision", bench.file("recipe.json", line_recipe),
                            "-y", "--json", "--count",   "1"};
  const Result run = bench.run(
      arguments, {.env = {{"LD_PRELOAD", BLACTL_LINE_CALLS}, {"FAKED_FULL", std::to_string(at)}}});
  INFO(at << run.out << run.err);
  std::set<std::string> kept;
  for (const auto& record : json_lines(bench.run({"-i", "sim:", "ledger", "--json"}).out)) {
    if (record.contains("record_id")) {
      kept.insert(record["record_id"]);
    }
  }
  for (const auto& record : json_lines(run.out)) {
    if (record.contains("record_id")) {
      CHECK(kept.contains(record["record_id"]));
    }
  }
  CHECK((run.status == 0) == contains(run.out, "\"pass\""));
  const Result again = bench.run(arguments);
  INFO(again.out << again.err);
  CHECK(again.status == 0);
}

#endif

TEST_CASE(
    "what another node wrote while a unit is read for the last time is not the unit's fault") {
  const Scene bench =
      line({{.serial = 101, .from = 1, .to = 90, .node_id = 7, .more = {{"servo_id", 1}}}});
  const auto run = [&](int at_ms, const char* order) {
    Scene scene = bench;
    scene.foreign(90, {{"orders",
                        {{{"at", std::to_string(at_ms) + "ms"},
                          {"to", 7},
                          {"order", order},
                          {"address", 0x38},
                          {"value", 100}}}}});
    return provision(scene, {"--count", "1", "--idle-timeout", "2"}, {}, short_recipe);
  };
  const Provisioned alone = run(80'000, "write");
  REQUIRE(alone.told() == "pass 1 7");
  const int end = 1100 + static_cast<int>(alone.records[0]["duration_s"].get<double>() * 1000);
  std::set<std::string> reasons;
  for (const char* order : {"write", "erase"}) {
    for (int at = end - 120; at < end + 80; at += 10) {
      const Provisioned disturbed = run(at, order);
      INFO(order << ' ' << at << ' ' << disturbed.result.out << disturbed.result.err);
      REQUIRE_FALSE(disturbed.records.empty());
      const auto& record = disturbed.records[0];
      CHECK(record["verdict"] != "fail");
      if (record["verdict"] == "error") {
        CHECK(record["code"] == "state");
        const std::string reason = record["reason"]; // perhaps with a remark on the clock
        reasons.insert(reason.substr(0, reason.find(';')));
      }
    }
  }
  CHECK(reasons ==
        std::set<std::string>{"node 90 wrote to node 7 meanwhile: what it holds now is not known"});
}
