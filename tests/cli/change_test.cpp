// What every change of a servo has in common, whichever command makes it: promised node IDs, writes
// that are not needed, warnings.

#include "catch.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

using namespace blactl::test;

namespace {

constexpr const char* absent = "00112233445566778899aabbccddee09";

std::ptrdiff_t rom_writes(const std::string& output) {
  const auto events = json_lines(output);
  return std::ranges::count_if(
      events, [](const nlohmann::json& event) { return event.value("event", "") == "rom_write"; });
}

/// Simulated servos at 11 and 12, with servo IDs of their own, and a table that promises 30 to a
/// unit that is away.
class Bus {
 public:
  /// `faults`: of the servo at 11.
  explicit Bus(nlohmann::json faults = nlohmann::json::object()) : faults_(std::move(faults)) {
    REQUIRE(
        run({"alloc", "--assign", std::string(absent) + "=30", "--once", "--wait", "2"}).status ==
        0);
  }

  [[nodiscard]] Result run(const Arguments& arguments) const {
    Arguments all{"-i", "sim:"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return bench_.run(all);
  }

  /// The unit that has a node ID by the table.
  [[nodiscard]] std::string holder(int node_id) const {
    const auto table = json(run({"alloc", "--list", "-j"}).out);
    for (const auto& entry : table["entries"]) {
      if (entry["node_id"] == node_id) {
        return entry["unique_id"];
      }
    }
    return {};
  }

  [[nodiscard]] std::string unit(int node_id) const {
    return json(
        run({"get", "-n", std::to_string(node_id), "0x46", "-j"}).out)["nodes"][0]["unique_id"];
  }

  /// ROM writes since power-on, and the end of the bus.
  [[nodiscard]] std::ptrdiff_t end() { return rom_writes(sim_.stop().out); }

 private:
  nlohmann::json faults_;
  Bench bench_;
  Background sim_{bench_,
                  {"sim", "-j",
                   Scene()
                       .servo("BLA21-12U-AB", 11, {{"servo_id", 1}, {"faults", faults_}})
                       .servo("BLA21-12U-AB", 12, {{"servo_id", 2}})
                       .write(bench_)}};
};

} // namespace

TEST_CASE("a wish takes the ID of a unit that is away over, and says whose it was") {
  const Arguments change =
      GENERATE(Arguments{"set", "-n", "11", "static_node_id=30", "--save", "-y"},
               Arguments{"alloc", "--static", "-n", "11", "--id", "30", "-y"});
  const Bus bus;
  const std::string unit = bus.unit(11);
  const Result changed = bus.run(change);
  INFO(changed.err);
  CHECK(changed.status == 0);
  CHECK(contains(changed.err, std::string("node ID 30 was given to uid:") + absent));
  CHECK(bus.holder(30) == unit);
}

TEST_CASE("an ID that ROM may hold, as its SAVE was answered and no restart came, stays given") {
  const Bus bus(nlohmann::json{{"stays", true}});
  const std::string unit = bus.unit(11);
  const Result changed = bus.run({"alloc", "--static", "-n", "11", "--id", "30", "-y"});
  INFO(changed.err);
  CHECK(changed.status == 1);
  CHECK(contains(changed.err, "node 11 gets it now"));
  CHECK(bus.holder(30) == unit);
}

TEST_CASE(
    "an ID that a restart has shown not to be in ROM is given back to the unit that is away") {
  const Bus bus(nlohmann::json{{"rom_write_fails", true}});
  const Result changed = bus.run({"alloc", "--static", "-n", "11", "--id", "30", "-y"});
  INFO(changed.err);
  CHECK(changed.status == 5);
  CHECK(bus.holder(30) == absent);
}

TEST_CASE("the ID of a unit that is there is refused, by whichever command") {
  const Arguments change =
      GENERATE(Arguments{"set", "-n", "11", "static_node_id=12", "--save", "-y"},
               Arguments{"alloc", "--static", "-n", "11", "--id", "12", "-y"});
  Bus bus;
  check_error(bus.run(change), 9, "duplicate_node_id", "node ID 12");
  CHECK(bus.end() == 0);
}

TEST_CASE("what is there already, in RAM and proven in ROM, is not saved again") {
  const Arguments change = GENERATE(
      Arguments{"alloc", "--static", "-n", "11", "--id", "20", "-y"},
      Arguments{"set", "-n", "serial:240900001", "angle_limit_cw=90deg", "--save", "-y"},
      Arguments{"pwm-config", "-n", "serial:240900001", "--range", "600us", "--save", "-y"});
  Bus bus;
  const Result first = bus.run(change);
  INFO(first.err);
  REQUIRE(first.status == 0);
  Arguments again = change;
  std::ranges::replace(again, std::string("11"), std::string("20"));
  const Result second = bus.run(again);
  INFO(second.err);
  CHECK(second.status == 0);
  CHECK(bus.end() == 1);
}

TEST_CASE("two servos exchange their IDs once, and a second time nothing is written") {
  Bus bus;
  const Arguments swap{"alloc",    "--static",           "--assign", bus.unit(11) + "=12",
                       "--assign", bus.unit(12) + "=11", "-y"};
  REQUIRE(bus.run(swap).status == 0);
  CHECK(bus.run(swap).status == 0);
  CHECK(bus.end() == 3); // one of them makes way
}

TEST_CASE("warnings of a plan are on stderr, and in JSON, not on stdout") {
  const Scene scene = three_servos();
  const Arguments set{"set", "-n", "11", "speed_p_gain=1", "-y"};
  const Result text = scene.run(set);
  CHECK(text.status == 0);
  Arguments with_json = set;
  with_json.emplace_back("-j");
  const Result document = scene.run(with_json);
  const auto warning = json(document.out)["nodes"][0]["warnings"][0];
  CHECK(warning["code"] == "leave_at_default");
  const auto said = warning["text"].get<std::string>();
  CHECK(contains(text.err, said));
  CHECK_FALSE(contains(text.out, said));
  CHECK(contains(document.err, said));
}

TEST_CASE("who does not answer which IDs it has is named by every command that gives one") {
  const Arguments change =
      GENERATE(Arguments{"set", "-n", "11", "static_node_id=40", "--save", "-y"},
               Arguments{"set", "-n", "11", "servo_id=9", "-y"},
               Arguments{"alloc", "--static", "-n", "11", "--id", "40", "-y"});
  const Scene scene =
      Scene()
          .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
          .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"faults", {{"mute", true}}}});
  const Result changed = scene.run(change);
  INFO(changed.err);
  CHECK(changed.status == 0);
  CHECK(contains(changed.err, "node 12 gave no answer about its IDs"));
}

TEST_CASE("the head of a node has the servo ID that a restart has brought back") {
  const Bus bus;
  REQUIRE(bus.run({"set", "-n", "11", "servo_id=9"}).status == 0);
  const Result restarted = bus.run({"restart", "-n", "11", "-y", "-j"});
  CHECK(restarted.status == 0);
  CHECK(json(restarted.out)["nodes"][0]["servo_id"] == 1);
}

TEST_CASE("what ROM brings back may forbid a change: that is no mistake of the user") {
  const Bench bench;
  const Scene scene =
      Scene().servo("BLA21-12U-AB", 11,
                    {{"rom", {{"pwm_mode", "speed"}, {"speed_torque_control", "on"}}},
                     {"ram", {{"pwm_mode", "angle"}, {"pwm_output_range", "90deg"}}}});
  const nlohmann::json file{
      {"schema", "blactl-fleet/1"},
      {"servos",
       {{{"name", "a"}, {"match", {{"node_id", 11}}}, {"set", {{"pwm_output_range", "90deg"}}}}}}};
  const Result result = scene.run(bench, {"apply", bench.file("fleet.json", file.dump()), "-y"});
  INFO(result.err);
  CHECK(result.status == 1); // not 2: a restart has been sent
  CHECK(codes(result) == std::vector<std::string>{"state"});
  CHECK(contains(result.err, "this servo has pwm_mode=speed"));
}
