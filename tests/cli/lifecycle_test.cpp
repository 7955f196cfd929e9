// save, erase, restart, wait and set --save of the built binary on simulated servos.

#include "catch.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <algorithm>

using namespace blactl::test;

namespace {

/// How many lines of the simulator's output report a ROM write.
std::ptrdiff_t rom_writes(const std::string& output) {
  const auto events = json_lines(output);
  return std::ranges::count_if(
      events, [](const nlohmann::json& event) { return event.value("event", "") == "rom_write"; });
}

nlohmann::json node(const Result& result, std::size_t index = 0) {
  return json(result.out).at("nodes").at(index);
}

} // namespace

TEST_CASE("set --save: the value survives the restart") {
  const Bench bench;
  Background sim(bench, {"sim", "--json"});
  const Result set =
      bench.run({"-i", "sim:", "set", "-n", "11", "angle_limit_cw=90deg", "--save", "-y", "-j"});
  CHECK(set.status == 0);
  CHECK(node(set)["saved"] == true);
  const Result restarted = bench.run({"-i", "sim:", "restart", "-n", "11", "-y"});
  CHECK(restarted.status == 0);
  const Result got = bench.run({"-i", "sim:", "get", "-n", "11", "angle_limit_cw", "-j"});
  CHECK(node(got)["params"][0]["raw"] == 900);
  CHECK(rom_writes(sim.stop().out) == 1);
}

TEST_CASE("what was not saved is gone after a restart") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  CHECK(bench.run({"-i", "sim:", "set", "-n", "11", "angle_limit_cw=90deg"}).status == 0);
  CHECK(bench.run({"-i", "sim:", "restart", "-n", "11", "-y"}).status == 0);
  const Result got = bench.run({"-i", "sim:", "get", "-n", "11", "angle_limit_cw", "-j"});
  CHECK(node(got)["params"][0]["raw"] == 1799);
}

TEST_CASE("a lost answer to SAVE leads to no second ROM write") {
  const Bench bench;
  const std::string scenario =
      Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"lose_opcode_answers", 1}}}}).write(bench);
  Background sim(bench, {"sim", scenario, "--json"});
  const Result saved = bench.run({"-i", "sim:", "save", "-n", "11", "-y", "-j"});
  CHECK(saved.status == 0);
  CHECK(node(saved)["status"] == "done");
  CHECK(rom_writes(sim.stop().out) == 1);
}

TEST_CASE("a SAVE that was lost itself is sent once more") {
  const Bench bench;
  const std::string scenario =
      Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"ignore_opcodes", 1}}}}).write(bench);
  Background sim(bench, {"sim", scenario, "--json"});
  CHECK(bench.run({"-i", "sim:", "save", "-n", "11", "-y"}).status == 0);
  CHECK(rom_writes(sim.stop().out) == 1);
}

TEST_CASE("a servo that ignores SAVE twice is no success") {
  const Result saved = Scene()
                           .servo("BLA21-12U-AB", 11, {{"faults", {{"ignore_opcodes", 9}}}})
                           .run({"save", "-n", "11", "-y", "-j"});
  CHECK(saved.status == 4);
  CHECK(node(saved)["status"] == "failed");
}

TEST_CASE("a servo that never comes back ends in 4 with a true report") {
  const Result saved = Scene()
                           .servo("BLA21-12U-AB", 11, {{"faults", {{"never_returns", true}}}})
                           .run({"save", "-n", "11", "-y", "-j"});
  CHECK(saved.status == 4);
  CHECK(codes(saved) == std::vector<std::string>{"not_back"});
  CHECK(node(saved)["status"] == "failed");
  CHECK(node(saved)["node_id_after"].is_null());
}

TEST_CASE("a ROM that kept its old values is found out") {
  const Result set = Scene()
                         .servo("BLA21-12U-AB", 11, {{"faults", {{"rom_write_fails", true}}}})
                         .run({"set", "-n", "11", "angle_limit_cw=90deg", "--save", "-y", "-j"});
  CHECK(set.status == 5);
  CHECK(node(set)["saved"] == false);
  CHECK(codes(set) == std::vector<std::string>{"mismatch"});
}

TEST_CASE("a servo that refuses SAVE ends in 5, one that answers and stays up in 1") {
  const auto saved = [](const char* fault) {
    return Scene()
        .servo("BLA21-12U-AB", 11, {{"faults", {{fault, true}}}})
        .run({"save", "-n", "11", "-y"});
  };
  CHECK(saved("refuse_opcodes").status == 5);
  const Result stays = saved("stays");
  CHECK(stays.status == 1);
  CHECK(codes(stays) == std::vector<std::string>{"state"});
}

TEST_CASE("a servo is followed to its new static ID") {
  const Result set = three_servos().run({"set", "-n", "11", "static_node_id=20", "--save", "-y"});
  CHECK(set.status == 0);
  CHECK(contains(set.out, "node 20"));
}

TEST_CASE("erase --save: a servo without an ID of its own gets the one it had") {
  const Bench bench;
  const std::string scenario = three_servos().write(bench);
  Background sim(bench, {"sim", scenario, "--json"});
  const Result erased = bench.run({"-i", "sim:", "erase", "-n", "12", "--save", "-y", "-j"});
  CHECK(erased.status == 0);
  CHECK(node(erased)["status"] == "done");
  CHECK(node(erased)["node_id_after"] == 12);
  const Result got = bench.run({"-i", "sim:", "get", "-n", "12", "static_node_id", "-j"});
  CHECK(node(got)["params"][0]["raw"] == 0);
  // And so does one whose ID has been dynamic all along.
  const Result saved = bench.run({"-i", "sim:", "save", "-n", "12", "-y"});
  CHECK(saved.status == 0);
  CHECK(rom_writes(sim.stop().out) == 2);
}

TEST_CASE("erase alone changes RAM only; --keep-ids leaves the IDs") {
  const Bench bench;
  const std::string scenario =
      Scene()
          .servo("BLA21-12U-AB", 11, {{"servo_id", 7}, {"rom", {{"soft_start", "off"}}}})
          .write(bench);
  Background sim(bench, {"sim", scenario, "--json"});
  CHECK(bench.run({"-i", "sim:", "erase", "-n", "11", "--keep-ids", "-y"}).status == 0);
  const Arguments get{"-i", "sim:", "get", "-n", "11", "servo_id", "static_node_id", "-j"};
  const Result kept = bench.run(get);
  CHECK(node(kept)["params"][0]["raw"] == 7);
  CHECK(node(kept)["params"][1]["raw"] == 11);
  CHECK(bench.run({"-i", "sim:", "erase", "-n", "11", "-y"}).status == 0);
  CHECK(node(bench.run(get))["params"][0]["raw"] == 0);
  CHECK(bench.run({"-i", "sim:", "restart", "-n", "11", "-y"}).status == 0);
  CHECK(node(bench.run(get))["params"][0]["raw"] == 7);
  CHECK(rom_writes(sim.stop().out) == 0);
}

TEST_CASE("what moves the shaft or erases is asked first") {
  for (const Arguments& command : {Arguments{"save"}, Arguments{"restart"}, Arguments{"erase"},
                                   Arguments{"erase", "--save"}}) {
    Arguments arguments = command;
    arguments.insert(arguments.end(), {"-n", "11"});
    const Result asked = three_servos().run(arguments);
    CHECK(asked.status == 7);
  }
  const Result off =
      Scene().servo("BLA21-12U-AB", 11, {{"rom", {{"torque_output", "off"}}}}).run({"save"});
  CHECK(off.status == 0); // nothing holds a load
}

TEST_CASE("an armed vehicle and a driven servo are left alone") {
  const Result armed = Scene()
                           .servo("BLA21-12U-AB", 11)
                           .foreign(40, {{"armed", true}})
                           .run({"save", "-n", "11", "-y"});
  CHECK(armed.status == 9);
  CHECK(codes(armed) == std::vector<std::string>{"armed"});
  const Scene driven = Scene()
                           .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
                           .foreign(40, {{"commands", {{"servo_ids", {1}}, {"value", 0.1}}}});
  CHECK(codes(driven.run({"restart", "-n", "11", "-y"})) == std::vector<std::string>{"driven"});
  CHECK(driven.run({"restart", "-n", "11", "-y", "--while-driven"}).status == 0);
}

TEST_CASE("several servos: each has its verdict") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11)
                          .servo("BLA15-06U-A0", 12, {{"faults", {{"never_returns", true}}}});
  const Result saved = scene.run({"save", "-n", "all", "-y", "-j", "--stagger", "0.5"});
  CHECK(saved.status == 6);
  CHECK(node(saved, 0)["status"] == "done");
  CHECK(node(saved, 1)["status"] == "failed");
  CHECK(json(saved.out)["counts"]["done"] == 1);
}

TEST_CASE("without -n the one servo there is; several are a question of their own") {
  CHECK(three_servos().run({"save", "-y"}).status == 2);
  CHECK(Scene().servo("BLA21-12U-AB", 11).run({"save", "-y"}).status == 0);
}

TEST_CASE("wait ends when the servos are there") {
  CHECK(three_servos().run({"wait", "-n", "11-13"}).status == 0);
  CHECK(three_servos().run({"wait", "-n", "model:BLA21"}).status == 0);
  const Result missing = three_servos().run({"wait", "-n", "44", "--wait", "1"});
  CHECK(missing.status == 4);
  CHECK(codes(missing) == std::vector<std::string>{"not_found"});
}

TEST_CASE("one process at a time writes on an interface; a killed one leaves no trace") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Background first(bench,
                   {"-i", "sim:", "--color", "never", "set", "-n", "11", "torque_output=off"},
                   {.terminal = true}, "Go on?");
  const Result second = bench.run({"-i", "sim:", "set", "-n", "12", "smoothing=off"});
  CHECK(second.status == 9);
  CHECK(codes(second) == std::vector<std::string>{"busy"});
  CHECK(contains(second.err, std::to_string(first.pid())));
  CHECK(bench.run({"-i", "sim:", "get", "-n", "12", "smoothing"}).status == 0); // readers are free
  first.kill();
  CHECK(bench.run({"-i", "sim:", "set", "-n", "12", "smoothing=off"}).status == 0);
}
