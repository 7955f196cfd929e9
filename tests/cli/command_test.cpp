// command of the built binary.

#include "catch.hpp"
#include "scene.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

/// 11 takes speed and torque, 12 angles only.
Scene two_servos() {
  return Scene()
      .servo("BLA21-12U-AB", 11,
             {{"servo_id", 3}, {"serial_number", 1}, {"rom", {{"speed_torque_control", "on"}}}})
      .servo("BLA21-12U-AB", 12, {{"servo_id", 4}, {"serial_number", 2}});
}

/// How often this register of any servo was written, by what was recorded.
std::size_t writes(const Bench& bench, const std::string& log, const std::string& address) {
  std::size_t count = 0;
  for (const auto& line : json_lines(bench.run({"trace", log, "--json"}).out)) {
    const bool is_request = line.value("kind", "") == "request";
    count += is_request && line["type"] == "uavcan.protocol.param.GetSet" &&
                     line["fields"]["name"] == address &&
                     line["fields"]["value"].contains("integer_value")
                 ? 1U
                 : 0U;
  }
  return count;
}

std::int64_t register_of(const Bench& bench, const std::string& node, const char* name) {
  const Result got = bench.run({"-i", "sim:", "get", "-n", node, name, "--json"});
  REQUIRE(got.status == 0);
  return json(got.out)["nodes"][0]["params"][0]["raw"];
}

} // namespace

TEST_CASE("command has exactly the keys of the contract, in their order") {
  const Result result = two_servos().run({"command", "-n", "11", "speed=60rpm", "--json", "-y"});
  CHECK(result.status == 0);
  const auto lines = json_lines(result.out);
  REQUIRE(lines.size() > 100);
  const auto first = ordered_json(result.out.substr(0, result.out.find('\n')));
  CHECK(keys(first) == std::vector<std::string>{"time", "node_id", "unique_id", "model",
                                                "serial_number", "servo_id", "firmware_version",
                                                "hardware_version", "angle_deg", "speed_rpm",
                                                "torque_pct", "command_speed"});
  CHECK(first["command_speed"] == 60);
  const auto& last = lines.back();
  CHECK(last["command"] == "command");
  CHECK(last["exit_status"] == 0);
  CHECK(last["counts"]["nodes"] == 1);
  CHECK(last["counts"]["samples"] == lines.size() - 1);
  const auto& end = lines[lines.size() - 2];
  CHECK(end["command_speed"] == 0); // how it came to a stand is seen, too
  CHECK(std::abs(end["speed_rpm"].get<int>()) <= 1);
}

TEST_CASE("command as comma-separated values is a step response") {
  const Result result =
      two_servos().run({"command", "-n", "12", "angle=45deg", "--csv", "-y", "--duration", "1"});
  CHECK(result.status == 0);
  CHECK(result.out.starts_with(
      "time,node_id,unique_id,model,serial_number,servo_id,firmware_version,hardware_version,"
      "angle_deg,speed_rpm,torque_pct,command_angle\n"));
  CHECK(contains(result.err, "node 12: held at 45.0 deg (the shaft is at 44."));
  CHECK(contains(result.err, "reached after 0."));
  CHECK(contains(result.err, "1000 ms after the last command the output goes off"));
}

TEST_CASE("people read ten lines a second, in either language") {
  const Result result = two_servos().run({"command", "-n", "12", "angle=45deg", "-y"});
  CHECK(result.status == 0);
  CHECK(contains(result.out, "command_angle    angle_deg"));
  CHECK(std::ranges::count(result.out, '\n') > 15);
  CHECK(std::ranges::count(result.out, '\n') < 25);
  const Result japanese =
      two_servos().run({"command", "-n", "12", "--wiggle", "-y", "--lang", "ja"});
  CHECK(japanese.status == 0);
  CHECK(contains(japanese.err, "保持しています"));
  CHECK(contains(japanese.err, "出力が OFF"));
}

TEST_CASE("what is no command sends not one frame") {
  const Bench bench;

  struct Case {
    Arguments arguments;
    int status;
    const char* says;
  };

  for (const Case& each : std::vector<Case>{
           {{"command"}, 2, "angle=45deg, speed=60rpm, torque=20%, or --wiggle"},
           {{"command", "angle=45"}, 2, "command_angle=45deg"},
           {{"command", "45deg"}, 2, "angle=45deg, speed=60rpm"},
           {{"command", "ANGLE=45"}, 2, "command_angle=45deg"},
           {{"command", "angle=45.05deg"}, 2, "angle"},
           {{"command", "speed=1000rpm"}, 2, "out_of_range"},
           {{"command", "angle_limit_cw=90deg"}, 2, "not a command"},
           {{"command", "angle=45deg", "--wiggle"}, 2, "--wiggle"},
           {{"command", "--wiggle", "--svg", "-"}, 2, "--svg"},
           {{"command", "--wiggle", "--svg", "/no/such/folder/a.svg"}, 1, "/no/such/folder"},
           {{"command", "--wiggle", "--duration", "0"}, 2, "--duration"},
           {{"command", "angle=555555555raw"}, 2, "out_of_range"},
       }) {
    Arguments all{"--record", (bench.folder() / "none.log").string(), "-y"};
    all.insert(all.end(), each.arguments.begin(), each.arguments.end());
    const Result result = two_servos().run(bench, all);
    INFO(result.err);
    CHECK(result.status == each.status);
    CHECK(contains(result.err, each.says));
    CHECK_FALSE(std::filesystem::exists(bench.folder() / "none.log"));
  }
}

TEST_CASE("command moves one servo, after a yes") {
  const Result several = two_servos().run({"command", "--wiggle", "-y"});
  CHECK(several.status == 2);
  const Result both = two_servos().run({"command", "--wiggle", "-y", "-n", "11,12"});
  CHECK(both.status == 2);
  CHECK(contains(both.err, "-n 11"));
  const Bench bench;
  const std::string log = (bench.folder() / "asked.log").string();
  const Result asked =
      two_servos().run(bench, {"command", "angle=45deg", "-n", "12", "--record", log});
  CHECK(asked.status == 7);
  CHECK(contains(asked.err, "from 0.0 deg to 45.0 deg"));
  CHECK(writes(bench, log, "0x00") == 0);
}

TEST_CASE("an autopilot, or an armed vehicle, makes command refuse") {
  const nlohmann::json commands{{"servo_ids", {4}}, {"type", 1}, {"value", 0.1}};
  const Bench bench;
  const std::string log = (bench.folder() / "refused.log").string();
  const Result driven =
      two_servos()
          .foreign(40, {{"kind", "autopilot"}, {"commands", commands}})
          .run(bench, {"command", "angle=45deg", "-n", "12", "-y", "--record", log});
  check_error(driven, 9, "driven", "node 40");
  CHECK(writes(bench, log, "0x00") == 0);
  const Result armed = two_servos()
                           .foreign(40, {{"armed", true}})
                           .run(bench, {"command", "angle=45deg", "-n", "12", "-y",
                                        "--while-driven", "--record", log});
  check_error(armed, 9, "armed", "armed");
  CHECK(writes(bench, log, "0x00") == 0);
  const Result other = two_servos()
                           .foreign(40, {{"kind", "autopilot"}, {"commands", commands}})
                           .run({"command", "angle=45deg", "-n", "11", "-y"});
  CHECK(other.status == 0); // the other servo is free
}

TEST_CASE("what the servo is switched to is told with what to type") {
  const auto refused = [](const char* motion, const nlohmann::json& rom) {
    return Scene()
        .servo("BLA21-12U-AB", 12, {{"rom", rom}})
        .run({"command", motion, "-n", "12", "-y"});
  };
  check_error(refused("speed=60rpm", {{"speed_torque_control", "off"}}), 2, "cross_check",
              "speed_torque_control");
  check_error(refused("speed=60rpm", {{"speed_torque_control", "on"}, {"timeout_action", "hold"}}),
              2, "cross_check", "timeout_action=hold");
  check_error(refused("angle=45deg", {{"torque_output", "off"}}), 2, "cross_check",
              "torque_output (0x20) is off");
  check_error(refused("angle=45deg", {{"angle_limit_cw", "20deg"}}), 2, "cross_check",
              "beyond its limits");
  check_error(refused("angle=45deg", {{"timeout_time", "10ms"}}), 2, "cross_check", "timeout_time");
}

TEST_CASE("limits of speed and torque that do not hold the shaft are told before it moves") {
  const auto moved = [](const nlohmann::json& rom) {
    const Result result = Scene()
                              .servo("BLA21-12U-AB", 12, {{"rom", rom}})
                              .run({"command", "angle=45deg", "-n", "12", "-y"});
    CHECK(result.status == 0);
    return result.err;
  };
  const std::string told = "have no effect while speed_torque_control (0x25) is off";
  CHECK(contains(moved({{"torque_limit_cw", "40%"}}), told));
  CHECK_FALSE(contains(moved({{"torque_limit_cw", "40%"}, {"speed_torque_control", "on"}}), told));
  CHECK_FALSE(contains(moved({{"smoothing", "on"}}), told));
}

TEST_CASE("a shaft that is stuck is no success") {
  const Bench bench;
  const std::string scenario = bench.file("s.json", R"({"schema":"blactl-scenario/1",
      "clock":"virtual","servos":[{"model":"BLA21-12U-AB","node_id":11,"serial_number":1}],
      "events":[{"at":"0s","servo":1,"world":{"stuck":"on"}}]})");
  const Result stuck =
      bench.run({"-i", "sim:" + scenario, "command", "angle=45deg", "-n", "11", "-y"});
  check_error(stuck, 5, "mismatch", "it was to be at 45.0 deg, and is held at");
}

TEST_CASE("by ArrayCommand a servo moves as by its registers, and only alone on its servo ID") {
  const Bench bench;
  const std::string log = (bench.folder() / "array.log").string();
  const Result array = two_servos().run(
      bench, {"command", "angle=-20deg", "--array", "-n", "12", "-y", "--record", log});
  CHECK(array.status == 0);
  CHECK(writes(bench, log, "0x00") <= 2); // its end alone
  CHECK(contains(bench.run({"trace", log, "--type", "ArrayCommand"}).out, "ArrayCommand"));
  const Result shared = two_servos()
                            .servo("BLA15-06U-A0", 13, {{"servo_id", 4}})
                            .run({"command", "angle=-20deg", "--array", "-n", "12", "-y"});
  check_error(shared, 9, "duplicate_servo_id", "13");
  const Result unheard =
      two_servos()
          .servo("BLA15-06U-A0", 13, {{"servo_id", 4}, {"faults", {{"no_actuator_status", true}}}})
          .run({"command", "angle=-20deg", "--array", "-n", "12", "-y"});
  check_error(unheard, 9, "duplicate_servo_id", "13");
}

TEST_CASE("a servo with servo ID 0 may be deaf to ArrayCommand, which is said as the reason") {
  const auto moved = [](bool obeys) {
    return Scene()
        .servo("BLA21-12U-AB", 11, {{"behaviour", {{"obeys_servo_id_0", obeys}}}})
        .run({"command", "angle=-20deg", "--array", "-n", "11", "-y"});
  };
  CHECK(moved(true).status == 0);
  const Result deaf = moved(false);
  check_error(deaf, 5, "mismatch", "it was to be at -20.0 deg");
  CHECK(contains(deaf.err, " set -n 11 servo_id=1 --save"));
}

TEST_CASE("ArrayCommand minds an actuator of another make only where it has the servo's ID") {
  const Arguments array{"command", "angle=-20deg", "--array", "-n", "12", "-y"};
  CHECK(two_servos().foreign(20, {{"actuator_id", 30}}).run(array).status == 0);
  check_error(two_servos().foreign(20, {{"actuator_id", 4}}).run(array), 9, "duplicate_servo_id",
              "20");
}

TEST_CASE("a drawing is a file of XML with what was told and done") {
  const Bench bench;
  const std::string file = (bench.folder() / "step.svg").string();
  const Result drawn =
      two_servos().run(bench, {"command", "angle=45deg", "-n", "12", "-y", "--svg", file});
  CHECK(drawn.status == 0);
  const std::string svg = content(file);
  CHECK(svg.starts_with("<?xml"));
  CHECK(svg.ends_with("</svg>\n"));
  CHECK(contains(svg, "BLA21-12U-AB"));
  CHECK(contains(svg, "stroke-dasharray"));
  CHECK(contains(svg, "torque [%]"));
}

TEST_CASE("Ctrl-C brings the shaft to a stand, and says so") {
  const Bench bench;
  const Background sim(bench, {"sim", two_servos().write(bench), "--clock", "real"});
  Background run(bench,
                 {"-i", "sim:", "command", "speed=30rpm", "-n", "11", "-y", "--duration", "60"}, {},
                 "command_speed");
  run.expect(" 30 rpm");
  const Result ended = run.stop(SIGINT);
  CHECK(ended.status == 130);
  CHECK(contains(ended.err, "bringing it to its end"));
  CHECK(contains(ended.err, "node 11: stopped at"));
  CHECK(codes(ended) == std::vector<std::string>{"interrupted"});
  CHECK(register_of(bench, "11", "command_speed") == 0);
  CHECK(register_of(bench, "11", "current_speed") == 0);
}

TEST_CASE("a reader that leaves ends it the same way") {
  const Bench bench;
  const Background sim(bench, {"sim", two_servos().write(bench), "--clock", "real"});
  const Result ended = bench.run(
      {"-i", "sim:", "command", "speed=30rpm", "-n", "11", "-y", "--duration", "60", "--csv"},
      {.leave_after = "command_speed"});
  CHECK(ended.status == 0);
  CHECK(register_of(bench, "11", "command_speed") == 0);
  CHECK(register_of(bench, "11", "current_speed") == 0);
}

TEST_CASE("a reader that does not read keeps no command from the shaft, nor its end") {
  const Bench bench;
  const Background sim(bench, {"sim", two_servos().write(bench), "--clock", "real"});
  const std::string pipe = (bench.folder() / "pipe").string();
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  REQUIRE(reader >= 0);
  // Some 100 KB in a pipe of 64 KB.
  Background run(
      bench,
      {"-i", "sim:", "command", "speed=30rpm", "-n", "11", "-y", "--json", "--duration", "4"},
      {.stdout_file = pipe}, "");
  run.expect("stopped at");
  CHECK(register_of(bench, "11", "command_speed") == 0);
  std::string out;
  for (int tries = 0; tries < 500 && !contains(out, "exit_status"); ++tries) {
    std::array<char, 65536> buffer{};
    const ssize_t count = read(reader, buffer.data(), buffer.size());
    out.append(buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
    pollfd more{.fd = reader, .events = POLLIN, .revents = 0};
    (void)poll(&more, 1, 20);
  }
  close(reader);
  CHECK(run.wait().status == 0);
  CHECK(json_lines(out).size() > 350);
}

TEST_CASE("stopped and woken again, it does not move the shaft on") {
  const Bench bench;
  const Background sim(bench, {"sim", two_servos().write(bench), "--clock", "real"});
  Background run(bench,
                 {"-i", "sim:", "command", "speed=30rpm", "-n", "11", "-y", "--duration", "60"}, {},
                 "command_speed");
  run.expect(" 30 rpm");
  REQUIRE(kill(run.pid(), SIGSTOP) == 0);
  const Result meanwhile = bench.run({"-i", "sim:", "monitor", "-n", "11", "--duration", "1.5"});
  CHECK(meanwhile.status == 0);
  REQUIRE(kill(run.pid(), SIGCONT) == 0);
  const Result ended = run.wait();
  CHECK(ended.status == 1);
  CHECK(codes(ended) == std::vector<std::string>{"state"});
  CHECK(contains(ended.err, "the servo's own timeout has acted"));
  CHECK(register_of(bench, "11", "command_speed") == 0);
}

TEST_CASE("killed with -9 it leaves a servo that stops by its own timeout") {
  const Bench bench;
  const Background sim(bench, {"sim", two_servos().write(bench), "--clock", "real"});
  Background run(bench,
                 {"-i", "sim:", "command", "speed=30rpm", "-n", "11", "-y", "--duration", "60"}, {},
                 "command_speed");
  run.expect(" 30 rpm");
  run.kill();
  CHECK(register_of(bench, "11", "command_speed") == 30); // nobody told it to stop
  // A reader: what it asks feeds no timeout (requirement 146).
  const Result watched = bench.run(
      {"-i", "sim:", "monitor", "-n", "11", "--duration", "2.5", "--json", "--rate", "10"});
  const auto lines = json_lines(watched.out);
  REQUIRE(lines.size() > 5);
  CHECK(lines[lines.size() - 2]["speed_rpm"] == 0);
}
