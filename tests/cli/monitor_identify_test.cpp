// blactl monitor --identify: torque off, a horn is turned, torque as it was.

#include "catch.hpp"
#include "scene.hpp"

#include <signal.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

/// 11 holds, 12 brakes, 13 is off; after 8 s a hand turns 12.
Scene airframe() {
  return Scene()
      .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
      .servo("BLA21-12U-AB", 12, {{"serial_number", 2}, {"ram", {{"torque_output", "brake"}}}})
      .servo("BLA21-12U-AB", 13, {{"serial_number", 3}, {"ram", {{"torque_output", "off"}}}})
      .world(2, {{"hand", "30deg"}}, "8s");
}

/// "11: torque_output=1", of what was recorded, in order.
std::vector<std::string> writes_of(const Bench& bench, const std::string& log) {
  std::vector<std::string> found;
  for (const auto& line : json_lines(bench.run({"trace", log, "--json"}).out)) {
    const bool is_request = line.value("kind", "") == "request";
    if (is_request && line["type"] == "uavcan.protocol.param.GetSet" &&
        line["fields"]["value"].contains("integer_value")) {
      found.push_back(line["destination"].dump() + ": " +
                      line["fields"]["name"].get<std::string>() + "=" +
                      line["fields"]["value"]["integer_value"].dump());
    }
  }
  return found;
}

std::vector<std::string> outputs(const Bench& bench) {
  std::vector<std::string> found;
  const Result got = bench.run({"-i", "sim:", "get", "torque_output", "--json"});
  const auto document = json(got.out);
  for (const auto& node : document["nodes"]) {
    found.push_back(node["params"][0]["text"].get<std::string>());
  }
  return found;
}

/// A run of it beside the test, which begins when torque is off.
const Arguments in_the_background{"-i", "sim:", "monitor", "--identify", "-y", "--json"};

} // namespace

TEST_CASE("the servo that a hand turns is told, and torque comes back as it was") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Result result = airframe().run(
      bench, {"monitor", "--identify", "-y", "--json", "--duration", "12", "--record", log});
  INFO(result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "torque is off, servos: 2 (11, 12)"));
  CHECK(contains(result.err, "Torque comes back, servos: 2 (11, 12). Hands off."));
  CHECK(contains(result.err, "torque is as it was before, servos: 2 (11, 12)"));
  std::vector<int> moved;
  std::size_t samples = 0;
  for (const auto& line : json_lines(result.out)) {
    if (line.contains("moved")) {
      ++samples;
      if (line["moved"] == true) {
        moved.push_back(line["node_id"]);
      }
    }
  }
  CHECK(samples > 60);
  CHECK((moved.size() >= 9 && moved.size() <= 11)); // 5 s
  CHECK(std::ranges::count(moved, 12) == std::ssize(moved));
  auto writes = writes_of(bench, log);
  REQUIRE(writes.size() == 4);
  std::sort(writes.begin(), writes.begin() + 2);
  std::sort(writes.begin() + 2, writes.end());
  CHECK(writes == std::vector<std::string>{"11: 0x20=1", "12: 0x20=1", "11: 0x20=0", "12: 0x20=2"});
}

TEST_CASE("the keys of a sample grow by moved, and only then") {
  const Arguments command{"monitor", "-y", "--count", "3", "-n", "11", "--csv"};
  Arguments with = command;
  with.emplace_back("--identify");
  CHECK(airframe().run(command).out.find("moved") == std::string::npos);
  CHECK(airframe().run(with).out.find(",stale,moved\n") != std::string::npos);
  check_error(airframe().run({"monitor", "--fields", "moved"}), 2, "usage", "--identify only");
}

TEST_CASE("without a yes nothing is written") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Result result = airframe().run(bench, {"monitor", "--identify", "--record", log});
  check_error(result, 7, "not_confirmed", "node 11: torque_output 0  (on) -> 1  (off)");
  CHECK(contains(result.err, "then it comes back"));
  CHECK(writes_of(bench, log).empty());
}

TEST_CASE("where torque is off already nobody is asked, and nothing is written") {
  const Result result = airframe().run({"monitor", "--identify", "-n", "13", "--duration", "1"});
  CHECK(result.status == 0);
  CHECK(contains(result.err, "no servo had torque"));
  CHECK_FALSE(contains(result.err, "Hands off"));
}

TEST_CASE("what cannot be written to is refused") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  REQUIRE(airframe().run(bench, {"monitor", "--duration", "1", "--record", log}).status == 0);
  CHECK(bench.run({"-i", "replay:" + log, "monitor", "--identify", "-y"}).status == 2);
  CHECK(airframe().run({"--listen-only", "monitor", "--identify", "-y"}).status == 2);
  check_error(Scene(airframe())
                  .foreign(40, {{"armed", true}})
                  .run({"monitor", "--identify", "-y", "-n", "11"}),
              9, "armed", "armed");
  CHECK(Scene().run({"monitor", "--identify", "-y"}).status == 4);
}

TEST_CASE("whatever signal ends it, torque comes back") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Bench bench;
    const Background sim(bench, {"sim", airframe().write(bench), "--clock", "real"});
    Background monitor(bench, in_the_background, {}, "\"node_id\":13");
    CHECK(outputs(bench) == std::vector<std::string>{"off", "off", "off"});
    const Result ended = monitor.stop(signal);
    INFO(ended.err);
    CHECK(ended.status == 128 + signal);
    CHECK(contains(ended.err, "10 s at most"));
    CHECK(contains(ended.err, "no torque is left off by this command"));
    CHECK(outputs(bench) == std::vector<std::string>{"on", "brake", "off"});
    CHECK(json(bench.run({"undo", "-i", "sim:", "--list", "--json"}).out)["snapshots"].empty());
  }
}

TEST_CASE("a second Ctrl-C ends it at once, and says what to type") {
  const Bench bench;
  const Background sim(bench, {"sim", airframe().write(bench), "--clock", "real"});
  Background monitor(bench, in_the_background, {}, "\"node_id\":13");
  REQUIRE(kill(monitor.pid(), SIGINT) == 0);
  monitor.expect("Hands off");
  const Result ended = monitor.stop(SIGINT);
  CHECK(ended.status == 130);
  CHECK(contains(ended.err, "blactl -i sim: set torque_output=on -n 11"));
  CHECK(contains(ended.err, "blactl -i sim: set torque_output=brake -n 12"));
  CHECK(outputs(bench) == std::vector<std::string>{"off", "off", "off"});
}

TEST_CASE("after a kill -9 undo gives the torque back") {
  const Bench bench;
  const Background sim(bench, {"sim", airframe().write(bench), "--clock", "real"});
  Background monitor(bench, in_the_background, {}, "\"node_id\":13");
  monitor.kill();
  CHECK(outputs(bench) == std::vector<std::string>{"off", "off", "off"});
  const Result undone = bench.run({"-i", "sim:", "undo", "-y"});
  INFO(undone.err);
  CHECK(undone.status == 0);
  CHECK(contains(undone.err, "monitor --identify"));
  CHECK(outputs(bench) == std::vector<std::string>{"on", "brake", "off"});
}

TEST_CASE("a servo that has gone is an error with what to type, the others are as before") {
  const Result result =
      Scene(airframe())
          .event(1, "power_off", "9s")
          .run({"monitor", "--identify", "-y", "--json", "--duration", "10", "-n", "11,12"});
  INFO(result.err);
  CHECK(result.status == 6);
  CHECK(codes(result) == std::vector<std::string>{"timeout"});
  CHECK(contains(result.err, "blactl set torque_output=on -n 11"));
  CHECK(contains(result.err, "before, servos: 1 (12)"));
}
