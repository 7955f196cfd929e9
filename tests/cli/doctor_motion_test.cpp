// doctor -n: why a servo does not move, or not as it should.

#include "catch.hpp"
#include "run.hpp"
#include "scene.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

using namespace blactl::test;

namespace {

using Codes = std::vector<std::string>;
using Json = nlohmann::json;

constexpr std::string_view model_with_pwm = "BLA21-12U-AB";

/// Servo ID 1 as node 11, with these settings in RAM.
Scene servo(const Json& ram = Json::object(), std::string_view model = model_with_pwm) {
  return Scene().servo(model, 11, {{"servo_id", 1}, {"serial_number", 7}, {"ram", ram}});
}

/// An autopilot that commands these servo IDs.
Scene& commanded(Scene& scene, const Json& servo_ids, int type, double value, double rate = 50) {
  return scene.foreign(
      100,
      {{"kind", "autopilot"},
       {"commands", {{"servo_ids", servo_ids}, {"type", type}, {"value", value}, {"rate", rate}}}});
}

/// Commanded by an angle within all limits.
Scene driven(const Json& ram = Json::object(), std::string_view model = model_with_pwm) {
  Scene scene = servo(ram, model);
  return commanded(scene, {1}, 1, 0.2);
}

Json findings(const Scene& scene, const Arguments& arguments) {
  const Result result = scene.run(arguments);
  INFO(result.out << result.err);
  CHECK((result.status == 0 || result.status == 8));
  return json(result.out)["findings"];
}

Codes codes_of(const Json& findings) {
  Codes all;
  for (const auto& finding : findings) {
    if (finding["code"] != "commander" && finding["code"] != "health") {
      all.push_back(finding["code"]);
    }
  }
  return all;
}

Codes named(const Scene& scene) {
  return codes_of(findings(scene, {"doctor", "-n", "11", "-j"}));
}

Codes unnamed(const Scene& scene) {
  return codes_of(findings(scene, {"doctor", "-j"}));
}

} // namespace

TEST_CASE("doctor -n invents nothing about a servo that follows its commander") {
  for (const char* model : {"BLA21-06U-A0", "BLA21-12U-AB", "BLA15-06U-A0", "BLA34-28U-AB"}) {
    INFO(model);
    const Scene scene = driven(Json::object(), model);
    CHECK(named(scene) == Codes{});
    CHECK(unnamed(scene) == Codes{});
    CHECK(codes_of(findings(scene, {"doctor", "-n", "all", "-j"})) == Codes{});
  }
}

TEST_CASE("doctor -n names a cause in the settings, and doctor names it of a commanded servo") {
  const auto& [ram, code, is_obstacle] = GENERATE(table<Json, std::string, bool>({
      {{{"torque_output", "off"}}, "torque_off", true},
      {{{"torque_output", "brake"}}, "torque_off", true},
      {{{"speed_torque_control", "on"}, {"torque_limit_cw", "0%"}, {"torque_limit_ccw", "0%"}},
       "torque_limit_zero",
       true},
      {{{"speed_torque_control", "on"}, {"speed_limit_cw", "0rpm"}}, "speed_limit_zero", true},
      {{{"speed_limit_cw", "60rpm"}}, "limits_without_effect", false},
      {{{"angle_limit_cw", "0deg"}, {"angle_limit_ccw", "0deg"}}, "angle_limits", true},
      {{{"angle_limit_cw", "10deg"}}, "command_beyond_limit", true},
  }));
  INFO(ram);
  CHECK(named(driven(ram)) == Codes{code});
  CHECK(unnamed(driven(ram)) == (is_obstacle ? Codes{code} : Codes{}));
  // Nobody commands it: the cause is told to who asks, and to nobody else.
  const Scene alone = servo(ram);
  const Codes asked = named(alone);
  const bool is_of_setting = code != "command_beyond_limit";
  CHECK(std::ranges::count(asked, code) == (is_of_setting ? 1 : 0));
  CHECK(std::ranges::count(asked, "not_commanded") == 1);
  CHECK(unnamed(alone) == Codes{});
}

TEST_CASE("doctor -n names what is wrong with the commands") {
  SECTION("nobody sends any") {
    CHECK(named(servo()) == Codes{"not_commanded"});
    CHECK(unnamed(servo()) == Codes{});
  }
  SECTION("they are for another servo ID") {
    Scene scene = servo();
    commanded(scene, {5}, 1, 0.2);
    CHECK(named(scene) == Codes{"no_such_servo", "commanded_other"});
  }
  SECTION("they are of a speed while 0x25 is off") {
    Scene scene = servo();
    commanded(scene, {1}, 3, 60);
    CHECK(named(scene) == Codes{"mode_without_effect"});
    CHECK(unnamed(scene) == Codes{"mode_without_effect"});
  }
  SECTION("they are written by another tool") {
    Scene scene = servo();
    Json orders = Json::array();
    for (int tenth = 10; tenth < 80; ++tenth) {
      orders.push_back({{"at", std::to_string(tenth * 100) + "ms"},
                        {"to", 11},
                        {"order", "write"},
                        {"address", 0},
                        {"value", 3000}});
    }
    scene.foreign(90, {{"orders", orders}});
    CHECK(named(scene) == Codes{"command_beyond_limit"});
    CHECK(unnamed(scene) == Codes{"command_beyond_limit"});
  }
  SECTION("they are too rare") {
    Scene scene = servo({{"timeout_time", "500ms"}});
    commanded(scene, {1}, 1, 0.2, 1);
    CHECK(named(scene) == Codes{"not_commanded"});
    CHECK(unnamed(scene) == Codes{"not_commanded"});
  }
}

TEST_CASE("doctor -n sees that CAN goes before pulses") {
  const Scene both = driven().world(7, {{"pulse", "1700us"}}, "0s");
  CHECK(named(both) == Codes{"pwm_has_no_say"});
  CHECK(unnamed(both) == Codes{});
  const Scene pulses = servo().world(7, {{"pulse", "1700us"}}, "0s");
  CHECK(named(pulses) == Codes{});
  const Scene short_pulses = servo().world(7, {{"pulse", "500us"}}, "0s");
  CHECK(named(short_pulses) == Codes{"pwm_has_no_say"});
}

TEST_CASE("doctor names the fault that holds the output off") {
  const Json world = GENERATE(Json{{"voltage", "3.6V"}}, Json{{"temperature", "95degC"}},
                              Json{{"driver_stopped", "on"}});
  INFO(world);
  const Scene scene = driven().world(7, world, "0s");
  CHECK(named(scene) == Codes{"fault_holds_off"});
  CHECK(unnamed(scene) == Codes{"fault_holds_off"});
}

TEST_CASE(
    "a finding of doctor -n has the keys of every finding, and people read why and what to do") {
  const Scene scene = servo({{"torque_output", "off"}});
  const auto document = ordered_json(scene.run({"doctor", "-n", "11", "-j"}).out);
  const auto& finding = document["findings"][0];
  CHECK(keys(finding) == std::vector<std::string>{"code", "level", "node_id", "text", "fix"});
  CHECK(finding["level"] == "warning");
  CHECK(finding["node_id"] == 11);
  const auto fix = finding["fix"].get<std::string>();
  CHECK(fix == "blactl set -n 11 torque_output=on --save");
  const Result english = scene.run({"doctor", "-n", "11"});
  CHECK(english.status == 8);
  CHECK(contains(english.out, "fix: " + fix));
  const Result japanese = scene.run({"doctor", "-n", "11", "--lang", "ja"});
  CHECK(contains(japanese.out, "torque_output (0x20) が off のため"));
  CHECK(contains(japanese.out, "対処: " + fix));
}

TEST_CASE("a fix of doctor lasts where typed as printed: saved, unless RAM alone is wrong") {
  const Bench bench;
  const Background sim(bench, {"sim", servo().write(bench)});
  const auto fix = [&] {
    const Result result = bench.run({"-i", "sim:", "doctor", "-n", "11", "-j"});
    const Json found = json(result.out)["findings"];
    for (const auto& finding : found) {
      if (finding["code"] == "torque_off") {
        return finding["fix"].get<std::string>();
      }
    }
    return std::string();
  };
  const auto set = [&](const Arguments& what) {
    Arguments arguments{"-i", "sim:", "set", "-n", "11", "-y"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    CHECK(bench.run(arguments).status == 0);
  };
  set({"torque_output=off"});
  CHECK(fix() == "blactl -i sim: set -n 11 torque_output=on");
  set({"torque_output=off", "--save"});
  CHECK(fix() == "blactl -i sim: set -n 11 torque_output=on --save");
}

TEST_CASE("doctor -n looks at the servos that it names only") {
  Scene scene = servo({{"torque_output", "off"}});
  scene.servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"ram", {{"torque_output", "off"}}}});
  const auto found = findings(scene, {"doctor", "-n", "12", "-j"});
  REQUIRE(found.size() == 2);
  CHECK(found[0]["code"] == "torque_off");
  CHECK(found[0]["node_id"] == 12);
  CHECK(found[1]["node_id"] == 12);
}

TEST_CASE("doctor -n answers from a log what is in it, and concludes nothing from what is not") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  Scene scene = servo({{"torque_output", "off"}});
  CHECK(scene.run(bench, {"--record", log, "doctor", "-n", "11"}).status == 8);
  const Result again = bench.run({"-i", "replay:" + log, "doctor", "-n", "11", "-j"});
  INFO(again.out << again.err);
  CHECK(codes_of(json(again.out)["findings"]) == Codes{"torque_off", "not_commanded"});
  std::string screen; // as candump shows it without stamps
  std::istringstream lines(content(log));
  for (std::string line; std::getline(lines, line);) {
    screen += line.substr(line.find(") ") + 2) + '\n';
  }
  const std::string untimed = bench.file("untimed.log", screen);
  const Result bare = bench.run({"-i", "replay:" + untimed, "doctor", "-n", "11", "-j"});
  INFO(bare.out << bare.err);
  CHECK(codes_of(json(bare.out)["findings"]) == Codes{"torque_off"});
  CHECK(scene.run(bench, {"--record", log, "scan", "--listen", "1"}).status == 0);
  const Result poor = bench.run({"-i", "replay:" + log, "doctor", "-n", "11", "-j"});
  INFO(poor.out << poor.err);
  CHECK(codes_of(json(poor.out)["findings"]) == Codes{});
}

TEST_CASE("doctor -n judges the settings of a fleet file, and nothing that is only heard") {
  const Bench bench;
  const std::string file =
      bench.file("fleet.json", R"({"schema": "blactl-fleet/1", "servos": [{"name": "a",
        "match": {"node_id": 11, "model": "BLA21-12U-AB"}, "set": {"static_node_id": 11,
        "servo_id": 1, "torque_output": "off"}}]})");
  const Result result = bench.run({"-i", "file:" + file, "doctor", "-n", "11", "-j"});
  INFO(result.out << result.err);
  CHECK(codes_of(json(result.out)["findings"]) == Codes{"torque_off"});
}

TEST_CASE("doctor -n does not judge a servo that answers no more") {
  const char* at = GENERATE("3502ms", "3510ms", "3520ms");
  INFO(at);
  CHECK(named(servo().event(7, "power_off", at)) == Codes{"timeout", "lost_answers"});
}

TEST_CASE("what doctor -n names is gone after the command that it tells") {
  const Bench bench;
  const Scene scene = servo({{"torque_output", "brake"},
                             {"speed_torque_control", "on"},
                             {"torque_limit_ccw", "0%"},
                             {"speed_limit_cw", "0rpm"},
                             {"speed_limit_ccw", "0rpm"},
                             {"angle_limit_cw", "0deg"},
                             {"angle_limit_ccw", "0deg"}});
  const Background sim(bench, {"sim", scene.write(bench)});
  const Arguments doctor{"-i", "sim:", "doctor", "-n", "11", "-j"};
  const auto found = json(bench.run(doctor).out)["findings"];
  CHECK(codes_of(found) == Codes{"torque_off", "torque_limit_zero", "speed_limit_zero",
                                 "angle_limits", "not_commanded"});
  for (const auto& finding : found) {
    std::istringstream words(finding["fix"].get<std::string>());
    Arguments mend{"-i", "sim:", "-y"};
    std::string word;
    words >> word;
    if (word == "blactl") {
      while (words >> word) {
        mend.push_back(word);
      }
      const Result mended = bench.run(mend);
      INFO(finding << mended.out << mended.err);
      CHECK(mended.status == 0);
    }
  }
  CHECK(codes_of(json(bench.run(doctor).out)["findings"]) == Codes{"not_commanded"});
}

TEST_CASE("doctor only reads: a servo that does not move is as it was") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  CHECK(driven({{"torque_output", "off"}})
            .run(bench, {"--record", log, "doctor", "-n", "11"})
            .status == 8);
  const Result sent = bench.run({"trace", log, "--type", "GetSet", "--kind", "request", "-j"});
  CHECK(contains(sent.out, "\"empty\""));
  CHECK_FALSE(contains(sent.out, "integer_value"));
}

TEST_CASE("the trial that doctor offers is within the limits of the servo") {
  for (const auto& [cw, ccw, offered] :
       {std::tuple("5deg", "-90deg", "angle=-10deg"), std::tuple("5deg", "-3deg", "angle=5deg"),
        std::tuple("90deg", "-90deg", "angle=10deg")}) {
    const Scene scene = servo({{"angle_limit_cw", cw}, {"angle_limit_ccw", ccw}});
    const auto found = findings(scene, {"doctor", "-n", "11", "-j"});
    REQUIRE(found[0]["code"] == "not_commanded");
    CHECK(contains(found[0]["fix"].get<std::string>(), offered));
    CHECK(scene.run({"command", "-n", "11", offered, "--duration", "1", "-y"}).status == 0);
  }
}

TEST_CASE("doctor says so where it was asked about a servo that it did not read") {
  const Result heard =
      driven({{"torque_output", "off"}}).run({"doctor", "-n", "11", "--listen-only"});
  CHECK(contains(heard.out, "why one does not move is not judged"));
  const Result read = driven().run({"doctor", "-n", "11"});
  CHECK_FALSE(contains(read.out, "not judged"));
  CHECK(contains(read.out, "nothing is wrong, as far as it was heard"));
}

TEST_CASE("doctor -n tells of a recording what it is too short, or too poor, to judge") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  CHECK(servo().run(bench, {"--record", log, "get", "--all", "-n", "11"}).status == 0);
  const Arguments doctor{"-i", "replay:" + log, "doctor", "-n", "11"};
  const auto in = [&](const char* form, const char* language = "en") {
    Arguments arguments = doctor;
    arguments.insert(arguments.end(), {form, "--lang", language});
    return bench.run(arguments);
  };
  const Result text = in("-v");
  INFO(text.out << text.err);
  CHECK(text.status == 0);
  CHECK(contains(text.out, "not judged  node 11: whether anybody commands it"));
  CHECK(contains(text.out, "nothing is wrong in the rest"));
  const auto told = json(in("-j").out)["not_judged"];
  REQUIRE(told.size() == 1);
  CHECK(told[0]["node_id"] == 11);
  CHECK(contains(told[0]["text"].get<std::string>(), "2 s are needed"));
  CHECK(contains(in("-j", "ja").out, "動作指令の有無"));
  CHECK(servo().run(bench, {"--record", log, "get", "smoothing", "-n", "11"}).status == 0);
  CHECK(contains(in("-j").out, "node 11: not in the recording: command_angle"));
  CHECK(json(servo().run({"doctor", "-n", "11", "-j"}).out)["not_judged"].empty());
}

TEST_CASE("doctor finds a servo that is blocked, and for -n a commander is no finding") {
  const Scene held = driven().world(7, {{"hand", "-30deg"}}, "0s");
  CHECK(named(held) == Codes{"torque_at_limit"});
  CHECK(unnamed(held) == Codes{"torque_at_limit"});
  const Result asked = driven().run({"doctor", "-n", "11"});
  CHECK(asked.status == 0);
  CHECK(contains(asked.out, "looked at: 1, others on the bus: 1, servos are commanded by: 100"));
}
