// save, erase, restart, wait and set --save of the built binary on simulated servos.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace blactl::test;

namespace {

/// How many lines of the simulator's output report a ROM write.
std::ptrdiff_t rom_writes(const std::string& output) {
  const auto events = json_lines(output);
  return std::ranges::count_if(
      events, [](const nlohmann::json& event) { return event.value("event", "") == "rom_write"; });
}

/// A simulator in real time with one servo, whose restart takes that much longer.
std::string slow_servo(const Bench& bench, const char* return_delay) {
  const nlohmann::json scenario{{"schema", "blactl-scenario/1"},
                                {"servos",
                                 {{{"model", "BLA21-12U-AB"},
                                   {"node_id", 11},
                                   {"faults", {{"return_delay", return_delay}}}}}}};
  return bench.file("slow.json", scenario.dump());
}

nlohmann::json node(const Result& result, std::size_t index = 0) {
  return json(result.out).at("nodes").at(index);
}

/// Eight servos from node ID 11 on, of which the last does not come back from a restart.
Scene eight_servos() {
  Scene scene;
  for (int id = 11; id < 18; ++id) {
    scene.servo("BLA21-12U-AB", id);
  }
  return scene.servo("BLA21-12U-AB", 18, {{"faults", {{"return_delay", "600s"}}}});
}

/// Seconds from the first sign of life after SAVE to the last register read of this servo.
double reread_time(std::vector<nlohmann::json> transfers, int id) {
  std::erase_if(transfers, [](const auto& line) { return !line.contains("type"); }); // the last one
  double saved = 0;
  double returned = 0;
  double last_read = 0;
  for (const nlohmann::json& transfer : transfers) {
    const auto& type = transfer["type"];
    const bool from = transfer["source"] == id;
    if (transfer["destination"] == id && type == "uavcan.protocol.param.ExecuteOpcode") {
      saved = transfer["time"];
    } else if (from && saved > 0 && returned == 0 && type == "uavcan.protocol.NodeStatus" &&
               transfer["fields"]["uptime_sec"] == 0) {
      returned = transfer["time"];
    } else if (from && returned > 0 && type == "uavcan.protocol.param.GetSet") {
      last_read = transfer["time"];
    }
  }
  REQUIRE(returned > 0);
  REQUIRE(last_read > returned);
  return last_read - returned;
}

} // namespace

TEST_CASE("set --save: a servo that is back is read again at once, whoever else is away") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Result set = eight_servos().run(bench, {"set", "-n", "all", "smoothing=off", "--save", "-y",
                                                "--wait", "4", "-j", "--record", log});
  CHECK(set.status == 6);
  const auto transfers = json_lines(bench.run({"trace", log, "--json"}).out);
  for (int id = 11; id < 18; ++id) {
    CAPTURE(id);
    CHECK(reread_time(transfers, id) < 0.3);
    CHECK(node(set, static_cast<std::size_t>(id - 11))["saved"] == true);
  }
  CHECK(node(set, 7)["saved"] == false);
}

TEST_CASE("Ctrl-C: what is saved and read again is told as such, whoever else is away") {
  const Bench bench;
  Background sim(bench, {"sim", eight_servos().write(bench), "--clock", "real", "--json"});
  Background set(
      bench,
      {"-i", "sim:", "set", "-n", "all", "smoothing=off", "--save", "-y", "-j", "--wait", "500"},
      {}, "");
  for (int id = 11; id < 19; ++id) {
    sim.expect("\"node_id\":" + std::to_string(id) + ",\"count\":1");
  }
  const Result ended = set.stop(SIGINT);
  CHECK(ended.status == 130);
  for (std::size_t i = 0; i < 7; ++i) {
    CAPTURE(i);
    CHECK(node(ended, i)["saved"] == true);
  }
  CHECK(node(ended, 7)["saved"] == false);
  CHECK(codes(ended) == std::vector<std::string>{"interrupted", "interrupted"});
}

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

TEST_CASE("before a servo saves it is said not to cut the supply, and at no other time",
          "[requirement-59]") {
  const std::string warning = "blactl: do not cut the supply while servos save\n";
  const Scene scene = Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"ignore_opcodes", 1}}}});
  for (const Arguments& saving :
       {Arguments{"save"}, Arguments{"set", "smoothing=off", "--save"},
        Arguments{"erase", "--save"}, Arguments{"pwm-config", "--neutral", "1600", "--save"},
        Arguments{"alloc", "--static", "--id", "21"}, Arguments{"characterize"}}) {
    Arguments arguments = saving;
    arguments.insert(arguments.end(), {"-n", "11", "-y", "-v"});
    const Result result = scene.run(arguments);
    INFO(saving.front() << '\n' << result.err);
    const std::size_t at = result.err.find(warning);
    REQUIRE(at != std::string::npos);
    CHECK(at < result.err.find("ExecuteOpcode"));
  }
  for (const Arguments& other : {Arguments{"restart"}, Arguments{"set", "smoothing=off"},
                                 Arguments{"erase"}, Arguments{"get"}}) {
    Arguments arguments = other;
    arguments.insert(arguments.end(), {"-n", "11", "-y"});
    INFO(other.front());
    CHECK_FALSE(contains(three_servos().run(arguments).err, "supply"));
  }
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
  CHECK(contains(saved.err, "it was given 5 s (--wait SEC gives it more)"));
  CHECK(contains(saved.err, "blactl wait -n uid:"));
}

TEST_CASE("a servo that refuses, or that nothing was sent to, is where it was") {
  const Result refused = Scene()
                             .servo("BLA21-12U-AB", 11, {{"faults", {{"refuse_opcodes", true}}}})
                             .run({"save", "-n", "11", "-y", "-j"});
  CHECK(refused.status == 5);
  CHECK(node(refused)["node_id_after"] == 11);
  const Result ignored = Scene()
                             .servo("BLA21-12U-AB", 11, {{"faults", {{"ignore_opcodes", 9}}}})
                             .run({"save", "-n", "11", "-y", "-j"});
  CHECK(ignored.status == 4);
  CHECK(node(ignored)["node_id_after"] == 11);
}

TEST_CASE("the duration of a SAVE that was sent twice begins with the first") {
  const Result saved = Scene()
                           .servo("BLA21-12U-AB", 11, {{"faults", {{"ignore_opcodes", 1}}}})
                           .run({"save", "-n", "11", "-y", "-j"});
  CHECK(saved.status == 0);
  CHECK(node(saved)["duration_s"].get<double>() > 1.5); // it had that long to carry out the first
}

TEST_CASE("on a terminal one line shows who is awaited, and nothing is left of it") {
  const Scene scene =
      Scene()
          .servo("BLA21-12U-AB", 11)
          .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"faults", {{"return_delay", "4s"}}}});
  const Arguments save{"save", "-n", "all", "-y"};
  const Result shown = scene.run(save, {.terminal = true, .columns = 60});
  CHECK(shown.status == 0);
  CHECK(contains(shown.err, "servos done: 1 of 2, 3 s; to come back: 12"));
  CHECK(shown.err.ends_with("\r\x1b[K"));
  CHECK_FALSE(contains(scene.run(save).err, "servos done"));
  CHECK_FALSE(contains(scene.run({"save", "-n", "all", "-y", "-q"}, {.terminal = true}).err,
                       "servos done"));
}

TEST_CASE("wait shows how long it waits, and an interrupted one leaves nobody out") {
  const Bench bench;
  Background sim(bench, {"sim", slow_servo(bench, "1s"), "--json"});
  const Result waited =
      bench.run({"-i", "sim:", "wait", "-n", "11,99", "--wait", "60", "-j"},
                {.answers = {{"waiting, 1 of 60 s; there: 1", "\x03"}}, .terminal = true});
  CHECK(waited.status == 130);
  const auto errors = json(waited.out)["errors"];
  REQUIRE(errors.size() == 2);
  CHECK(errors[0]["code"] == "interrupted");
  CHECK(errors[1]["code"] == "interrupted");
  CHECK(errors[1]["node_id"] == 99);
  CHECK(node(waited)["status"] == "done");
}

TEST_CASE("a wait whose cable is cut is not said to be interrupted") {
  const Result waited = three_servos().clients("cut", "3s").run({"wait", "-n", "11,99", "-j"});
  CHECK(waited.status == 3);
  const auto errors = json(waited.out)["errors"];
  REQUIRE(errors.size() == 2);
  CHECK(errors[0]["code"] == "no_acknowledge");
  CHECK(errors[1]["code"] == "no_acknowledge");
  CHECK(errors[1]["node_id"] == 99);
}

TEST_CASE("a servo that waits for a node ID is not said to be absent") {
  const Scene scene = three_servos().servo(
      "BLA21-12U-AB", 0, {{"unique_id", "a1b2c3d4e5f60718293a4b5c6d7e8f90"}, {"servo_id", 9}});
  for (const std::string uid : {"uid:a1b2c3d4e5f60718293a4b5c6d7e8f90", "uid:a1b2"}) {
    const Result waited = scene.run({"wait", "-n", uid, "--wait", "3"});
    CHECK(waited.status == 4);
    CHECK(contains(waited.err, uid + " waits for a node ID: it cannot be asked before it has one"));
  }
  CHECK(contains(scene.run({"wait", "-n", "uid:a1b3", "--wait", "3"}).err,
                 "no servo on the bus matches uid:a1b3"));
}

TEST_CASE("wait does not call a servo operational that is gone") {
  const Bench bench;
  const std::string file = bench.file("gone.json", R"({"schema": "blactl-scenario/1",
      "clock": "virtual",
      "servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1, "serial_number": 1},
                 {"model": "BLA21-12U-AB", "node_id": 12, "servo_id": 2, "serial_number": 2}],
      "events": [{"at": "2s", "servo": 1, "happens": "power_off"},
                 {"at": "0s", "servo": 2, "happens": "power_off"},
                 {"at": "9s", "servo": 2, "happens": "power_on"}]})");
  const Result waited = bench.run({"-i", "sim:" + file, "wait", "-n", "11,12", "-j"});
  CHECK(waited.status == 6);
  CHECK(node(waited, 0)["status"] == "failed");
  CHECK(node(waited, 1)["status"] == "done");
  CHECK(json(waited.out)["errors"][0]["code"] == "timeout");
  CHECK(json(waited.out)["errors"][0]["node_id"] == 11);
}

TEST_CASE("wait without -n hears everybody who lives before it ends") {
  const Bench bench;
  const std::string file = bench.file("late.json", R"({"schema": "blactl-scenario/1",
      "clock": "virtual",
      "servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1, "serial_number": 1},
                 {"model": "BLA21-12U-AB", "node_id": 12, "servo_id": 2, "serial_number": 2}],
      "events": [{"at": "0s", "servo": 2, "happens": "power_off"},
                 {"at": "500ms", "servo": 2, "happens": "power_on"}]})");
  const Result waited = bench.run({"-i", "sim:" + file, "wait", "-j"});
  CHECK(waited.status == 0);
  CHECK(json(waited.out)["nodes"].size() == 2);
}

TEST_CASE("wait does not tell of one of two servos on an ID what may be the other's") {
  const Bench bench;
  const Scene scene = three_servos().servo("BLA21-12U-AB", 11, {{"servo_id", 4}});
  Background sim(bench, {"sim", scene.write(bench), "--clock", "real", "--json"});
  REQUIRE(bench.run({"-i", "sim:", "scan"}).status == 9); // both have started
  const Result waited = bench.run({"-i", "sim:", "wait", "-n", "11", "--wait", "2", "-j"});
  CHECK(waited.status == 9);
  CHECK(node(waited)["node_id"] == 11);
  for (const auto* key : {"unique_id", "model", "serial_number", "servo_id"}) {
    CHECK(node(waited)[key].is_null());
  }
}

TEST_CASE("a servo whose output comes on by erase holds the shaft where it is") {
  const Bench bench;
  const std::string scenario = bench.file("s.json", R"({"schema":"blactl-scenario/1",
      "clock":"virtual","servos":[{"model":"BLA21-12U-AB","node_id":11,"serial_number":1,
      "ram":{"torque_output":"off"}}],
      "events":[{"at":"500ms","servo":1,"world":{"hand":"-80deg"}}]})");
  const Result erased = bench.run({"-i", "sim:" + scenario, "erase", "-n", "11", "-y", "-j"});
  INFO(erased.err);
  CHECK(erased.status == 0);
  CHECK(node(erased)["status"] == "done");
}

TEST_CASE("a ROM that kept its old values is found out") {
  const Result set = Scene()
                         .servo("BLA21-12U-AB", 11, {{"faults", {{"rom_write_fails", true}}}})
                         .run({"set", "-n", "11", "angle_limit_cw=90deg", "--save", "-y", "-j"});
  CHECK(set.status == 5);
  CHECK(node(set)["saved"] == false);
  CHECK(codes(set) == std::vector<std::string>{"mismatch"});
}

TEST_CASE("a servo that cannot read its ROM after the restart is no success") {
  // Its supply is cut while it writes: then it runs with initial values, which are just those that
  // were to be saved.
  const Bench bench;
  const std::string scenario = bench.file("s.json",
                                          R"({"schema":"blactl-scenario/1","clock":"virtual",
          "servos":[{"model":"BLA21-12U-AB","node_id":11,"behaviour":{"rom_write_time":"3s"}}],
          "events":[{"at":"4s","servo":240900001,"world":{"plugged":"off"}},
                    {"at":"4.2s","servo":240900001,"world":{"plugged":"on"}}]})");
  const Result erased =
      bench.run({"-i", "sim:" + scenario, "erase", "-n", "11", "--save", "-y", "-j"});
  CHECK(erased.status == 5);
  CHECK(codes(erased) == std::vector<std::string>{"mismatch"});
  CHECK(contains(erased.err, "could not read its ROM"));
  CHECK(node(erased)["status"] == "failed");
}

TEST_CASE("a servo with an ID of its own that loses its ROM in a save is met again, and says so") {
  const Result set = Scene()
                         .servo("BLA21-12U-AB", 17, {{"faults", {{"power_loss_in_save", "10ms"}}}})
                         .run({"set", "-n", "17", "angle_limit_cw=90deg", "--save", "-y", "-j"});
  CHECK(set.status == 5);
  CHECK(contains(set.err, "could not read its ROM"));
  CHECK(node(set)["saved"] == false);
}

TEST_CASE("a head tells of the servo as it is in the end") {
  const Result erased = Scene()
                            .servo("BLA21-12U-AB", 11, {{"servo_id", 7}})
                            .run({"erase", "-n", "11", "--save", "-y", "-j"});
  CHECK(node(erased)["servo_id"] == 0);
}

TEST_CASE("what ROM did not take and what a servo refuses have hints of their own") {
  const auto run = [](const char* fault, const Arguments& arguments) {
    return Scene().servo("BLA21-12U-AB", 11, {{"faults", {{fault, true}}}}).run(arguments).err;
  };
  CHECK(contains(run("rom_write_fails", {"set", "-n", "11", "reverse=on", "--save", "-y"}),
                 "ROM did not take what RAM held"));
  CHECK(contains(run("refuse_opcodes", {"save", "-n", "11", "-y"}), "--group fault"));
  CHECK(contains(run("refuse_opcodes", {"erase", "-n", "11", "-y"}), "--group fault"));
}

TEST_CASE("wait waits for nothing that is recorded, and tells a mute servo from one that is away") {
  const Bench bench;
  const std::string log = bench.file("r.log", "(1.000000) can0 1401550B#00000000000000C0\n");
  CHECK(bench.run({"-i", "replay:" + log, "wait", "-n", "12"}).status == 2);
  const Result mute = Scene()
                          .servo("BLA21-12U-AB", 20, {{"faults", {{"mute", true}}}})
                          .run({"wait", "-n", "20", "--wait", "1"});
  CHECK(mute.status == 4);
  CHECK(contains(mute.err, "does not answer"));
}

TEST_CASE("erase --save that breaks off before SAVE is done with no servo") {
  int broken = 0;
  for (int at_ms = 2100; at_ms < 2400; at_ms += 3) {
    const Bench bench;
    const std::string scenario = bench.file(
        "s.json", R"({"schema":"blactl-scenario/1","clock":"virtual","servos":[)"
                  R"({"model":"BLA21-12U-AB","node_id":11},{"model":"BLA21-12U-AB","node_id":12}],)"
                  R"("events":[{"at":")" +
                      std::to_string(at_ms) + R"(ms","clients":"bus_off"}]})");
    const Result erased =
        bench.run({"-i", "sim:" + scenario, "erase", "-n", "all", "--save", "-y", "-j"});
    const auto document = json(erased.out);
    for (const auto& one : document.at("nodes")) {
      CHECK((one.at("status") == "failed" || document.at("exit_status") == 0));
      broken += document.at("exit_status") == 3 ? 1 : 0;
    }
  }
  CHECK(broken > 0);
}

TEST_CASE("a servo that fails after its restart, while others are looked at, is not another one") {
  constexpr int second = 240900002;
  int failed = 0;
  for (int at = 2300; at < 3500; at += 100) {
    const Result restarted = Scene()
                                 .servo("BLA21-12U-AB", 122, {{"serial_number", 240900001}})
                                 .servo("BLA15-12U-A0", 13, {{"serial_number", second}})
                                 .event(second, "rom_error", std::to_string(at) + "ms")
                                 .run({"restart", "-n", "all", "-y", "--json"});
    INFO(at << ": " << restarted.err);
    CHECK_FALSE(contains(restarted.out + restarted.err, "another servo"));
    failed += restarted.status != 0 ? 1 : 0;
  }
  CHECK(failed > 0);
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

TEST_CASE("what moves the shaft or erases is asked first", "[requirement-64]") {
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

TEST_CASE("Ctrl-C: a save that runs is waited for, and what is known of it is said") {
  const Bench bench;
  Background sim(bench, {"sim", slow_servo(bench, "1s"), "--json"});
  Background save(bench, {"-i", "sim:", "save", "-n", "11", "-y", "-j"}, {}, "");
  sim.expect("rom_write");
  const Result saved = save.stop(SIGINT);
  CHECK(saved.status == 130);
  CHECK(contains(saved.err, "waiting for servos that save"));
  CHECK(codes(saved) == std::vector<std::string>{"interrupted"});
  CHECK(node(saved)["node_id_after"] == 11);
  CHECK(node(saved)["status"] == "done"); // it came back in time, and was read again
  CHECK(rom_writes(sim.stop().out) == 1);
}

TEST_CASE("Ctrl-C: a servo that does not come back is waited for no longer than that") {
  const Bench bench;
  Background sim(bench, {"sim", slow_servo(bench, "600s"), "--json"});
  Background save(bench, {"-i", "sim:", "save", "-n", "11", "-y", "-j", "--wait", "500"}, {}, "");
  sim.expect("rom_write");
  const Result saved = save.stop(SIGINT);
  CHECK(saved.status == 130);
  CHECK(codes(saved) == std::vector<std::string>{"interrupted", "interrupted"});
  CHECK(node(saved)["node_id_after"].is_null());
}

TEST_CASE("a second signal ends a running save at once") {
  const Bench bench;
  Background sim(bench, {"sim", slow_servo(bench, "600s"), "--json"});
  Background save(bench, {"-i", "sim:", "save", "-n", "11", "-y", "-j", "--wait", "500"}, {}, "");
  sim.expect("rom_write");
  REQUIRE(kill(save.pid(), SIGINT) == 0);
  save.expect("waiting for servos that save");
  const Result saved = save.stop(SIGTERM);
  CHECK(saved.status == 143); // the second one, not the end of the 3 s
  CHECK(codes(saved) == std::vector<std::string>{"interrupted", "interrupted"});
  CHECK(contains(saved.err, "not known"));
}

TEST_CASE("Ctrl-C: what was not begun is not begun") {
  const Bench bench;
  Background sim(bench, {"sim", "--json"});
  Background save(bench, {"-i", "sim:", "save", "-n", "11,12", "-y", "-j", "--stagger", "60"}, {},
                  "");
  sim.expect("rom_write");
  const Result saved = save.stop(SIGINT);
  CHECK(saved.status == 130);
  CHECK(contains(saved.err, "node 12: interrupted before anything was sent"));
  CHECK(node(saved, 1)["status"] == "failed");
  CHECK(rom_writes(sim.stop().out) == 1);
}

TEST_CASE("a servo that is unplugged while others restart is not told to be back") {
  std::vector<int> untold;
  for (int at = 40; at < 2600; at += 40) {
    Scene scene;
    scene.servo("BLA21-12U-AB", 11, {{"serial_number", 1}}).servo("BLA21-12U-AB", 12);
    scene.world(1, {{"plugged", "off"}}, std::to_string(at) + "ms");
    if (scene.run({"restart", "-n", "11,12", "-y", "-j", "--stagger", "2"}).status == 0) {
      untold.push_back(at);
    }
  }
  CHECK(untold == std::vector<int>{});
}

TEST_CASE(
    "a servo that restarts while others are still saved is not proven, however it reads later") {
  const auto save = [](const char* off, const char* on) {
    Scene scene;
    scene.servo("BLA21-12U-AB", 11, {{"serial_number", 1}}).servo("BLA21-12U-AB", 12);
    scene.world(1, {{"plugged", "off"}}, off).world(1, {{"plugged", "on"}}, on);
    return scene.run({"save", "-n", "11,12", "-y", "-j", "--stagger", "8"});
  };
  for (const auto& [off, on] : {std::pair("4s", "4.1s"), std::pair("9s", "9.1s")}) {
    const Result saved = save(off, on);
    INFO(off << ' ' << saved.out);
    check_error(saved, 6, "state", "node 11 has restarted since its ROM was proven");
    CHECK(node(saved)["status"] == "failed");
    CHECK(node(saved, 1)["status"] == "done");
  }
}

TEST_CASE("--stagger keeps the distance between servos") {
  const Bench bench;
  Background sim(bench, {"sim", three_servos().write(bench), "--json"});
  CHECK(bench.run({"-i", "sim:", "save", "-n", "11-13", "-y", "--stagger", "2.5"}).status == 0);
  std::vector<double> times;
  for (const auto& event : json_lines(sim.stop().out)) {
    if (event.value("event", "") == "rom_write") {
      times.push_back(event["time"]);
    }
  }
  REQUIRE(times.size() == 3);
  CHECK(times[1] - times[0] > 2.4); // each servo takes its own time to answer and to write
  CHECK(times[2] - times[1] > 2.4);
}

TEST_CASE("--stagger keeps the distance also where node IDs are exchanged in several rounds") {
  const Bench bench;
  Background sim(bench, {"sim", three_servos().write(bench), "--json"});
  Document entries = Document::array();
  for (const auto& [servo_id, then] : {std::pair(1, 12), std::pair(2, 11)}) {
    entries.push_back({{"name", std::to_string(servo_id)},
                       {"match", {{"servo_id", servo_id}}},
                       {"set", {{"static_node_id", then}}}});
  }
  const Document fleet{{"schema", "blactl-fleet/1"}, {"servos", entries}};
  const Result applied = bench.run(
      {"-i", "sim:", "apply", bench.file("fleet.json", fleet.dump()), "-y", "--stagger", "3"});
  INFO(applied.err);
  REQUIRE(applied.status == 0);
  std::vector<double> times;
  for (const auto& event : json_lines(sim.stop().out)) {
    if (event.value("event", "") == "rom_write") {
      times.push_back(event["time"]);
    }
  }
  REQUIRE(times.size() == 3);
  CHECK(times[1] - times[0] > 2.9);
  CHECK(times[2] - times[1] > 2.9);
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

TEST_CASE("a servo that was alone on the bus for long is one servo") {
  const Bench bench;
  const std::string file = bench.file("alone.json", R"({"schema": "blactl-scenario/1",
      "servos": [{"model": "BLA21-12U-AB", "node_id": 11}]})");
  Background sim(bench, {"sim", file, "--json"});
  std::this_thread::sleep_for(std::chrono::milliseconds(1200)); // its frames wait for a reader
  const Result set = bench.run({"-i", "sim:", "set", "-n", "11", "smoothing=off", "-y"});
  CHECK(set.status == 0);
  CHECK(set.err.empty());
}

TEST_CASE("a servo that may still write its ROM is not to be switched off, one that restarts may") {
  const Scene gone = Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"never_returns", true}}}});
  const Result saved = gone.run({"save", "-n", "11", "-y"});
  check_error(saved, 4, "not_back", "leave it powered");
  CHECK_FALSE(contains(saved.err, "power it off"));
  const Result restarted = gone.run({"restart", "-n", "11", "-y"});
  check_error(restarted, 4, "not_back", "power it off and on");
  CHECK_FALSE(contains(restarted.err, "ROM"));
}
