#include "catch.hpp"
#include "scene.hpp"
#include "tap.hpp"

using namespace blactl::test;

namespace {

struct Case {
  std::string assignment;
  std::string address;
  int raw;
};

nlohmann::json changes(const Result& result) {
  return json(result.out)["nodes"][0]["changes"];
}

/// A servo with the labels of a BLA21 that is a BLA15 inside: it knows other limits than its
/// profile.
Scene impostor(const std::string& out_of_range) {
  return Scene().servo("BLA15-06U-A0", 11,
                       {{"model_number", 61},
                        {"hardware_version", 12050},
                        {"behaviour", {{"out_of_range", out_of_range}}}});
}

Scene with_firmware(int version) {
  return Scene().servo("BLA21-12U-AB", 11, {{"firmware_version", version}});
}

} // namespace

TEST_CASE("set has exactly the keys of the contract, in their order") {
  const Result result =
      three_servos().run({"set", "-n", "11", "angle_limit_cw=90deg", "smoothing=on", "--json"});
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  const auto document = ordered_json(result.out);
  CHECK(keys(document) == std::vector<std::string>{"schema", "command", "interface", "exit_status",
                                                   "nodes", "counts", "errors"});
  const auto& node = document["nodes"][0];
  CHECK(keys(node) == std::vector<std::string>{"node_id", "unique_id", "model", "serial_number",
                                               "servo_id", "firmware_version", "hardware_version",
                                               "changes", "saved"});
  REQUIRE(node["changes"].size() == 2);
  CHECK(node["changes"][0].dump() ==
        R"({"address":"0x38","name":"angle_limit_cw","before":1799,"requested":900,)"
        R"("after":900,"status":"written"})");
  CHECK(node["changes"][1].dump() ==
        R"({"address":"0x22","name":"smoothing","before":1,"requested":1,)"
        R"("after":1,"status":"unchanged"})");
  CHECK(node["saved"] == false);
}

TEST_CASE("set says what was there, what is there now, and that it is not saved") {
  const Result result = three_servos().run({"set", "-n", "11", "angle_limit_cw=90deg"});
  CHECK(result.status == 0);
  CHECK(contains(result.out,
                 "  0x38  angle_limit_cw  1799  (179.9 deg)  ->  900  (90.0 deg)  written\n"));
  CHECK(contains(
      result.out,
      "in RAM only: a restart brings back what ROM holds (to keep the new values: blactl save)\n"));
  const Result same = three_servos().run({"set", "-n", "11", "angle_limit_cw=179.9deg"});
  CHECK(same.status == 0);
  CHECK(contains(same.out, "unchanged\n"));
  CHECK_FALSE(contains(same.out, "in RAM only"));
}

TEST_CASE("values are taken in every spelling of the contract") {
  const std::vector<Case> cases{
      {"angle_limit_cw=90deg", "0x38", 900},
      {"angle_limit_cw=090.0deg", "0x38", 900},
      {"angle_limit_cw=179.80deg", "0x38", 1798},
      {"angle_limit_cw=900raw", "0x38", 900},
      {"0x38=900", "0x38", 900},
      {"0x38=900raw", "0x38", 900},
      {"0X38=90deg", "0x38", 900},
      {"angle-limit-cw=90deg", "0x38", 900},
      {"ANGLE_LIMIT_CW=90deg", "0x38", 900},
      {"angle_limit_ccw=-45.5deg", "0x39", -455},
      {"timeout_time=1.5s", "0x27", 1500},
      {"timeout_time=1500ms", "0x27", 1500},
      {"timeout_time=1500000us", "0x27", 1500},
      {"timeout_time=1500", "0x27", 1500},
      {"voltage_limit_high=24.0V", "0x40", 240},
      {"overcurrent_limit=6.5A", "0x2A", 65},
      {"0x2A=65", "0x2A", 65},
      {"angle_boost=1.5%", "0x2F", 15},
      {"torque_limit_cw=80%", "0x3C", 80},
      {"torque_limit_cw=80", "0x3C", 80},
      {"speed_limit_cw=60rpm", "0x3A", 60},
      {"pwm_neutral=1500us", "0x34", 1500},
      {"temperature_limit_low=-30degC", "0x3F", -30},
      {"servo_id=7", "0x45", 7},
      {"torque_output=off", "0x20", 1},
      {"torque_output=BRAKE", "0x20", 2},
      {"torque_output=1", "0x20", 1},
      {"timeout_action=hold", "0x26", 0},
      {"soft_start=off", "0x21", 0},
      {"pwm_mode=speed", "0x37", 1},
  };
  for (const Case& one : cases) {
    INFO(one.assignment);
    const Result result =
        three_servos().run({"set", "-n", "11", one.assignment, "--dry-run", "--json"});
    CHECK(result.status == 8);
    const auto change = changes(result)[0];
    CHECK(change["address"] == one.address);
    CHECK(change["requested"] == one.raw);
    CHECK(change["status"] == "planned");
    CHECK(change["after"].is_null());
  }
}

TEST_CASE("--dry-run tells whether something would change, and changes nothing") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Tap tap(bench);
  const Arguments set{"-i", "sim:", "set", "-n", "11", "--dry-run"};
  const auto with = [&](const std::string& assignment) {
    Arguments arguments = set;
    arguments.push_back(assignment);
    return bench.run(arguments);
  };
  const Result changing = with("torque_output=off");
  CHECK(changing.status == 8);
  CHECK(contains(changing.out, "->  1  (off)  planned\n"));
  CHECK(with("torque_output=on").status == 0);
  CHECK(tap.writes().empty());
}

TEST_CASE(
    "--dry-run --save tells that all of RAM goes to ROM, also where nothing is written before") {
  const Result same =
      three_servos().run({"set", "-n", "11", "torque_output=on", "--save", "--dry-run"});
  CHECK(same.status == 8);
  CHECK(contains(same.out, "unchanged"));
  CHECK(contains(same.out, "then SAVE: all of RAM goes to ROM, and the servo restarts\n"));
}

TEST_CASE("who comes while others are looked for is not left out silently") {
  const auto plug = [](const char* at, const char* to) {
    return nlohmann::json{{"at", at}, {"servo", 8}, {"world", {{"plugged", to}}}};
  };
  const auto servo = [](int node_id, int serial) {
    return nlohmann::json{
        {"model", "BLA21-12U-AB"}, {"node_id", node_id}, {"serial_number", serial}};
  };
  const nlohmann::json scenario{{"schema", "blactl-scenario/1"},
                                {"clock", "virtual"},
                                {"servos", {servo(11, 7), servo(12, 8), servo(0, 9)}},
                                {"events", {plug("1ms", "off"), plug("400ms", "on")}}};
  const Bench bench;
  const std::string interface = "sim:" + bench.file("s.json", scenario.dump());
  const auto set = [&](const char* nodes) {
    return bench.run({"-i", interface, "set", "-n", nodes, "smoothing=on", "-y"});
  };
  const Result all = set("all");
  CHECK(all.status == 1);
  CHECK(codes(all) == std::vector<std::string>{"state"});
  CHECK(contains(all.err, "node 12 has come to the bus"));
  CHECK(contains(all.err, "they have no node ID: at least 1"));
  CHECK(set("11").status == 0);
}

TEST_CASE("set writes only what differs, in the order asked, and it stays") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Tap tap(bench);
  CHECK(bench.run({"-i", "sim:", "set", "-n", "11", "smoothing=off", "servo_id=1", "0x38=900"})
            .status == 0);
  CHECK(tap.writes() == std::vector<std::string>{"0x22=0", "0x38=900"});
  CHECK(bench.run({"-i", "sim:", "set", "-n", "11", "smoothing=off", "0x38=900"}).status == 0);
  CHECK(tap.writes().empty());
  const Result read = bench.run({"-i", "sim:", "get", "-n", "11", "0x38", "smoothing"});
  CHECK(contains(read.out, "900  (90.0 deg)"));
  CHECK(contains(read.out, "0  (off)"));
}

TEST_CASE("a static refusal sends not one frame") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Tap tap(bench);
  for (const char* assignment : {"0x49=1", "0x03=1", "0x60=1", "current_angle=1deg", "0x12=1",
                                 "torque_limit_cw=101%", "angle_limit_cw=90"}) {
    INFO(assignment);
    CHECK(bench.run({"-i", "sim:", "set", "-n", "11", "smoothing=off", assignment}).status == 2);
  }
  CHECK(tap.frames() == 0);
}

TEST_CASE("nothing lets the boot loader be started: no option, no file", "[requirement-80]") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Tap tap(bench);
  const std::string fleet = bench.file("fleet.json", R"({"schema": "blactl-fleet/1", "servos": [
      {"name": "a", "match": {"node_id": 11}, "set": {"0x49": 1}}]})");
  const std::string params = bench.file("wing.param", "0x49 1\n");
  const std::string forbidden = "0x49 starts the boot loader: the specification forbids writing it";
  for (const auto& [command, reason] :
       {std::pair(Arguments{"set", "-n", "11", "0x49=1"}, forbidden),
        std::pair(Arguments{"set", "-n", "11", "bootloader=0", "--save"}, forbidden),
        std::pair(Arguments{"get", "-n", "11", "0x49"}, std::string("neither read nor written")),
        std::pair(Arguments{"apply", fleet}, forbidden),
        std::pair(Arguments{"apply", "-n", "11", params}, std::string("no setting of a BLA"))}) {
    Arguments arguments = command;
    arguments.insert(arguments.end(), {"-i", "sim:", "-y", "--while-driven", "--overwrite-rom",
                                       "--profile", "BLA21-12U-AB"});
    const Result result = bench.run(arguments);
    INFO(command.front() << '\n' << result.err);
    CHECK(result.status == 2);
    CHECK(contains(result.err, reason));
  }
  CHECK(tap.frames() == 0);
}

TEST_CASE("if one of several servos refuses, none is written", "[requirement-77]") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Tap tap(bench);
  const Result result =
      bench.run({"-i", "sim:", "set", "-n", "11,12", "smoothing=off", "overcurrent_limit=6.5A"});
  check_error(result, 2, "out_of_range",
              "node 12: overcurrent_limit=6.5A: outside of the range 1.0A to 3.0A\n"
              "  type a value from 1.0A to 3.0A");
  CHECK(result.out.empty());
  CHECK(tap.writes().empty());
}

TEST_CASE("a value is checked against the servo's own model", "[requirement-77]") {
  check_error(three_servos().run({"set", "-n", "13", "speed_limit_cw=100rpm"}), 2, "out_of_range",
              "node 13: speed_limit_cw=100rpm: outside of the range 0rpm to 80rpm");
  CHECK(three_servos().run({"set", "-n", "11", "speed_limit_cw=100rpm"}).status == 0);
}

TEST_CASE("what the firmware or the model lacks is refused with the reason", "[requirement-160]") {
  check_error(with_firmware(1100).run({"set", "angle_boost=1%"}), 2, "unsupported",
              "node 11: angle_boost (0x2F) needs firmware 1.200, this servo has 1.100\n"
              "  `blactl models BLA21-12U-AB` shows which firmware has which features");
  for (const char* assignment :
       {"speed_torque_control=on", "overcurrent_limit=6.5A", "pwm_neutral=1500us"}) {
    INFO(assignment);
    check_error(with_firmware(1010).run({"set", assignment}), 2, "unsupported",
                "needs firmware 1.100, this servo has 1.010");
    CHECK(with_firmware(1100).run({"set", assignment, "-y"}).status == 0);
  }
  check_error(three_servos().run({"set", "-n", "12", "pwm_neutral=1500us"}), 2, "unsupported",
              "node 12: BLA15-06U-A0 has no PWM input: pwm_neutral (0x34) can only be 0\n"
              "  BLA15-06U-A0 is driven over CAN alone");
}

TEST_CASE("the unit of the PWM output range must be that of the PWM mode") {
  const auto set = [](const Arguments& assignments) {
    Arguments arguments{"set", "-n", "11", "-y", "-j"};
    arguments.insert(arguments.end(), assignments.begin(), assignments.end());
    return three_servos().run(arguments);
  };
  CHECK(changes(set({"pwm_output_range=60deg"}))[0]["after"] == 600);
  CHECK(changes(set({"pwm_mode=speed", "pwm_output_range=60rpm"}))[1]["after"] == 60);
  CHECK(changes(set({"pwm_output_range=600raw"}))[0]["after"] == 600);
  const Result wrong = set({"pwm_output_range=60rpm"});
  check_error(wrong, 2, "usage",
              "\n  type pwm_output_range=60.0deg, or pwm_mode=speed pwm_output_range=60rpm\n");
  CHECK(contains(wrong.err, "node 11: pwm_output_range=60rpm: this servo has pwm_mode="));
}

TEST_CASE("a servo that restarts at the write with other settings in ROM is not written to again") {
  const auto arguments =
      GENERATE(Arguments{"set", "-n", "11", "pwm_output_range=90deg", "-y"},
               Arguments{"set", "-n", "11", "pwm_output_range=90deg", "--save", "-y"},
               Arguments{"set", "-n", "11", "pwm_mode=angle", "pwm_output_range=90deg", "-y"},
               Arguments{"pwm-config", "-n", "11", "--output", "90deg", "-y"});
  const Scene scene = Scene().servo(
      "BLA21-12U-AB", 11,
      {{"rom",
        {{"pwm_mode", "speed"}, {"pwm_output_range", "150rpm"}, {"speed_torque_control", "on"}}},
       {"ram", {{"0x37", 0}, {"0x36", 700}}},
       {"faults", {{"restart_after_answer", {{{"to", "write"}, {"number", 1}}}}}}});
  check_error(scene.run(arguments), 1, "state",
              "restarted while it was written to: pwm_mode is speed now, and was angle");
}

TEST_CASE("a value that was equal and not sent is unchanged also where SAVE fails") {
  const Scene scene =
      Scene().servo("BLA21-12U-AB", 11,
                    {{"faults", {{"restart_after_answer", {{{"to", "opcode"}, {"number", 1}}}}}}});
  const Result got =
      scene.run({"set", "-n", "11", "smoothing=on", "0x2C=10", "--save", "-y", "--json"});
  INFO(got.out);
  const auto changed = json(got.out)["nodes"][0]["changes"];
  REQUIRE(changed.size() == 2);
  CHECK(changed[0]["status"] == "unchanged");
}

TEST_CASE("a servo that restarts at the write with the same settings in ROM is written to again") {
  const Scene scene =
      Scene().servo("BLA21-12U-AB", 11,
                    {{"faults", {{"restart_after_answer", {{{"to", "write"}, {"number", 1}}}}}}});
  const Result got = scene.run({"set", "-n", "11", "angle_limit_cw=90deg", "-y", "--json"});
  CHECK(got.status == 0);
  CHECK(json(got.out)["nodes"][0]["warnings"][0]["code"] == "restarted");
  CHECK(contains(got.err, "node 11: restarted while it was written to, and was written to again"));
}

TEST_CASE("a servo that does not take the value ends with 5 and what it holds instead",
          "[requirement-73]") {
  const Result refused = impostor("refuse").run({"set", "overcurrent_limit=6.5A", "-j"});
  check_error(refused, 5, "refused",
              "node 11: overcurrent_limit=6.5 A: the servo did not take it and still holds 2.1 A\n"
              "  is it the model that it says it is?");
  CHECK(changes(refused)[0]["status"] == "failed");
  CHECK(changes(refused)[0]["after"] == 21);

  const Result clamped = impostor("clamp").run({"set", "overcurrent_limit=6.5A", "-j"});
  check_error(clamped, 5, "mismatch",
              "node 11: overcurrent_limit=6.5 A: the servo holds 3.0 A instead\n"
              "  is it the model that it says it is?");
  CHECK(changes(clamped)[0]["status"] == "mismatch");
  CHECK(changes(clamped)[0]["after"] == 30);
}

TEST_CASE("one servo done and one that refuses is 6") {
  const Result result =
      impostor("refuse").servo("BLA21-12U-AB", 12).run({"set", "-n", "11,12", "0x2A=65", "-j"});
  CHECK(result.status == 6);
  const auto nodes = json(result.out)["nodes"];
  CHECK(nodes[0]["changes"][0]["status"] == "failed");
  CHECK(nodes[1]["changes"][0]["status"] == "written");
}

TEST_CASE("set without -n means the one servo there is") {
  CHECK(Scene().servo("BLA21-12U-AB", 11).foreign(40).run({"set", "servo_id=3"}).status == 0);
  check_error(three_servos().run({"set", "servo_id=9"}), 2, "usage",
              "several servos are on the bus: 11, 12, 13\n  say which: -n 11");
  check_error(Scene().foreign(40).run({"set", "servo_id=3"}), 4, "not_found",
              "nodes on the bus: 40; none is known to be a BLA servo");
  check_error(three_servos().run({"set", "-n", "55", "servo_id=3"}), 4, "not_found",
              "node 55 is not on the bus\n  see who is there: blactl scan");
  check_error(three_servos().run({"set", "-n", "model:BLA21-28U", "servo_id=3"}), 4, "not_found",
              "no servo on the bus matches model:BLA21-28U");
}

TEST_CASE("nothing is written on a guess of the model") {
  const Scene unknown = Scene().servo("BLA21-12U-AB", 11, {{"model_number", 99}});
  const std::string add = "\n  add a profile for this model with --profile-dir DIR";
  check_error(unknown.run({"set", "smoothing=off"}), 9, "no_profile",
              "node 11: no profile fits this servo (0x50=99): it is only read" + add);
  check_error(unknown.run({"set", "smoothing=off", "--profile", "BLA21-12U-AB"}), 9, "no_profile",
              "it is only read");
  const Scene unknown_class = Scene().servo("BLA21-12U-AB", 11, {{"hardware_version", 59050}});
  check_error(unknown_class.run({"set", "voltage_limit_high=20V"}), 9, "no_profile",
              "voltage_limit_high (0x40) depends on the model, and 0x53=59050 fits more than "
              "one: BLA21-06U-AB, BLA21-12U-AB, BLA21-28U-AB" +
                  add);
  CHECK(unknown_class.run({"set", "smoothing=off"}).status == 0);
  check_error(three_servos().run({"set", "-n", "11", "smoothing=off", "--profile", "BLA34-28U-AB"}),
              9, "model_mismatch", "the servo is BLA21-12U-AB, not BLA34-28U-AB");
}

TEST_CASE("nothing is written to a doubled node ID") {
  const Scene scene = three_servos().servo("BLA21-12U-AB", 11, {{"servo_id", 4}});
  check_error(scene.run({"set", "-n", "11", "smoothing=off", "--yes", "--while-driven"}), 9,
              "duplicate_node_id", "two units use node ID 11");
  CHECK(scene.run({"set", "-n", "12", "smoothing=off"}).status == 0);
}

TEST_CASE("a node ID that another unit has is not given away") {
  for (const char* taken : {"12", "40"}) {
    check_error(
        three_servos().foreign(40).run({"set", "-n", "11", std::string("static_node_id=") + taken}),
        9, "duplicate_node_id",
        std::string("node 11 would get node ID ") + taken + ", which another unit has (uid:");
  }
  CHECK(three_servos().run({"set", "-n", "11", "static_node_id=21"}).status == 0);
}

TEST_CASE("a node ID that another servo will have after a restart is not given away") {
  const Bench bench;
  const Background sim(bench, {"sim", three_servos().write(bench), "--clock", "real"});
  CHECK(bench.run({"-i", "sim:", "set", "-n", "11", "static_node_id=50"}).status == 0);
  check_error(bench.run({"-i", "sim:", "set", "-n", "12", "static_node_id=50"}), 9,
              "duplicate_node_id",
              "node 12 would get node ID 50, which node 11 has, or gets once it is saved");
}

TEST_CASE("a servo ID that another servo has is not given away, 0 excepted") {
  check_error(three_servos().run({"set", "-n", "11", "servo_id=3"}), 9, "duplicate_servo_id",
              "node 11 would have servo ID 3, which node ");
  const Scene unheard =
      Scene()
          .servo("BLA21-12U-AB", 11)
          .servo("BLA21-12U-AB", 12, {{"servo_id", 3}, {"faults", {{"no_actuator_status", true}}}});
  check_error(unheard.run({"set", "-n", "11", "servo_id=3"}), 9, "duplicate_servo_id", "node 12");
  check_error(three_servos().run({"set", "-n", "11,12", "servo_id=9"}), 9, "duplicate_servo_id",
              "one servo ID for 2 servos");
  CHECK(three_servos().run({"set", "-n", "11,12", "servo_id=0"}).status == 0);
}

TEST_CASE("a servo ID that an actuator of another make has is not given away") {
  const Scene scene = Scene().servo("BLA21-12U-AB", 11).foreign(20, {{"actuator_id", 3}});
  check_error(scene.run({"set", "-n", "11", "servo_id=3", "-y"}), 9, "duplicate_servo_id",
              "node 11 would have servo ID 3, which node 20");
  const Result other = scene.run({"set", "-n", "11", "servo_id=4", "-y"});
  CHECK(other.status == 0);
  CHECK_FALSE(contains(other.err, "node 20"));
}

TEST_CASE("a command is not saved") {
  check_error(three_servos().run({"set", "-n", "11", "command_angle=10deg", "--save", "-y"}), 2,
              "usage", "command_angle is a command: SAVE does not keep it");
}

TEST_CASE("a command that the servo does not take as it is switched names the switch") {
  check_error(three_servos().run({"set", "-n", "11", "command_speed=60rpm", "-y"}), 2,
              "cross_check", "while speed_torque_control (0x25) is off");
  CHECK(three_servos()
            .run({"set", "-n", "11", "speed_torque_control=on", "command_speed=60rpm", "-y"})
            .status == 0);
}

TEST_CASE("what the manufacturer advises to leave at its default is a warning") {
  const Result set =
      three_servos().run({"set", "-n", "11", "speed_p_gain=1", "--dry-run", "--json"});
  CHECK(set.status == 8);
  CHECK(json(set.out)["nodes"][0]["warnings"][0]["code"] == "leave_at_default");
}

TEST_CASE("limits of speed and torque that have no effect are a warning with what to type") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11)
                          .servo("BLA21-12U-AB", 12)
                          .servo("BLA21-12U-AB", 13, {{"rom", {{"speed_torque_control", "on"}}}});
  const auto said = [&](Arguments more) {
    more.insert(more.begin(), {"set", "speed_limit_cw=5rpm", "torque_limit_cw=10%", "--json"});
    return scene.run(more);
  };
  const Result both = said({"-n", "11,12"});
  CHECK(both.status == 0);
  for (const auto& node : json(both.out)["nodes"]) {
    REQUIRE(node["warnings"].size() == 1);
    CHECK(node["warnings"][0]["code"] == "limits_without_effect");
    CHECK(both.err ==
          "blactl: nodes 11, 12: " + node["warnings"][0]["text"].get<std::string>() + '\n');
  }
  CHECK(contains(both.err, "have no effect while speed_torque_control (0x25) is off"));
  CHECK(contains(both.err, "speed_torque_control=on"));
  CHECK(contains(said({"-n", "11", "--lang", "ja"}).err,
                 "speed_torque_control (0x25) が OFF の間は無視されます"));
  const Result in_effect = said({"-n", "13"});
  CHECK(in_effect.status == 0);
  CHECK(in_effect.err.empty());
}

TEST_CASE("a torque limit of 0 is asked with what it does now") {
  const auto asked = [](const std::string& assignment, const nlohmann::json& rom) {
    const Result result =
        Scene().servo("BLA21-12U-AB", 11, {{"rom", rom}}).run({"set", "-n", "11", assignment});
    CHECK(result.status == 7);
    return result.err;
  };
  const std::string lets_go = "\n    (with a torque limit of 0 % the servo lets go of the load)\n";
  CHECK(
      contains(asked("torque_limit_cw=0%", {{"speed_torque_control", "off"}}),
               "torque_limit_cw 100  (100 %) -> 0  (0 %)\n    (it has no effect while "
               "speed_torque_control (0x25) is off; with it on the servo lets go of the load)\n"));
  CHECK(contains(asked("torque_limit_cw=0%", {{"speed_torque_control", "on"}}),
                 "-> 0  (0 %)" + lets_go));
  CHECK(contains(asked("speed_torque_control=on", {{"torque_limit_ccw", "0%"}}),
                 "-> 1  (on)" + lets_go));
}

// On a bus that has been running: the vehicle said armed before this command began, and will say
// so again within a second.
TEST_CASE("nothing at all is written while the vehicle is armed") {
  const Bench bench;
  const Scene scene = three_servos().foreign(40, {{"armed", true}});
  const Background sim(bench, {"sim", scene.write(bench), "--clock", "real"});
  Tap tap(bench);
  const Result result =
      bench.run({"-i", "sim:", "set", "-n", "11", "smoothing=off", "--yes", "--while-driven"});
  check_error(
      result, 9, "armed",
      "node 40 says that the vehicle is armed: nothing is written while it is\n  disarm it first");
  CHECK(tap.writes().empty());
  CHECK(bench.run({"-i", "sim:", "get", "-n", "11", "smoothing"}).status == 0);
}

TEST_CASE("a servo that somebody drives is not made to move, except by --while-driven") {
  const Scene scene = three_servos().foreign(
      40, {{"commands", {{"servo_ids", {1}}, {"type", 1}, {"value", 0.1}, {"rate", 50}}}});
  check_error(scene.run({"set", "-n", "11", "torque_output=off", "--yes"}), 9, "driven",
              "node 40 commands node 11: not while it does\n  stop it, or add --while-driven");
  CHECK(scene.run({"set", "-n", "11", "torque_output=off", "--yes", "--while-driven"}).status == 0);
  CHECK(scene.run({"set", "-n", "11", "angle_p_gain=50"}).status == 0);
  CHECK(scene.run({"set", "-n", "12", "torque_output=off", "--yes"}).status == 0);
}

TEST_CASE("without a terminal what needs a yes fails, and --yes is one") {
  const Result asked = three_servos().run({"set", "-n", "11", "torque_output=off"});
  check_error(asked, 7, "not_confirmed",
              "This can move the shaft or let go of the load:\n"
              "  node 11: torque_output 0  (on) -> 1  (off)\n"
              "not confirmed: nothing was written\n  add --yes to agree beforehand");
  CHECK(asked.out.empty());
  CHECK(three_servos().run({"set", "-n", "11", "torque_output=off", "-y"}).status == 0);
}

TEST_CASE("what can move the shaft or let go of the load is asked, the rest is not") {
  constexpr std::int64_t pulse_too_short = 1 << 21; // there is a PWM signal
  const Scene scene =
      Scene().servo("BLA21-12U-AB", 11, {{"ram", {{"fault_notice", pulse_too_short}}}});
  const auto is_asked = [&](const std::string& assignment) {
    INFO(assignment);
    const int status = scene.run({"set", "-n", "11", assignment}).status;
    CHECK((status == 7 || status == 0));
    return status == 7;
  };
  for (const char* asked :
       {"command_angle=10deg", "torque_output=brake", "reverse=on", "extended_angle=on",
        "timeout_action=hold", "timeout_time=2s", "origin=1deg", "torque_limit_cw=0%",
        "torque_limit_ccw=0%", "temperature_limit_high=25degC", "voltage_limit_high=12V",
        "voltage_limit_low=12V", "pwm_neutral=1500us", "pwm_range=600us", "pwm_mode=speed"}) {
    CHECK(is_asked(asked));
  }
  for (const char* free :
       {"angle_limit_cw=90deg", "angle_limit_ccw=-90deg", "torque_limit_cw=50%",
        "temperature_limit_high=60degC", "voltage_limit_high=15V", "angle_p_gain=50",
        "soft_start=off", "smoothing=off", "servo_id=9", "torque_output=on"}) {
    CHECK_FALSE(is_asked(free));
  }
}

TEST_CASE("an angle limit inside the present angle is asked") {
  const Scene scene = Scene().servo("BLA21-12U-AB", 11,
                                    {{"ram", {{"current_angle", "30deg"}, {"soft_start", "off"}}}});
  CHECK(scene.run({"set", "angle_limit_cw=20deg"}).status == 7);
  CHECK(scene.run({"set", "angle_limit_cw=40deg"}).status == 0);
}

TEST_CASE("on a terminal the question is answered there") {
  const Arguments arguments{"set", "-n", "11", "torque_output=off"};
  const auto answered = [&](const std::string& answer) {
    return three_servos().run(arguments,
                              {.answers = {{"Go on? [y/N] ", answer}}, .terminal = true});
  };
  const Result yes = answered("y\n");
  CHECK(yes.status == 0);
  CHECK(contains(yes.err, "  node 11: torque_output 0  (on) -> 1  (off)\nGo on? [y/N] "));
  CHECK(contains(yes.out, "->  1  (off)  written\n"));
  CHECK(answered("yes\n").status == 0);
  for (const char* no : {"n\n", "\n", "yo\n", "\x04"}) {
    const Result result = answered(no);
    CHECK(result.status == 7);
    CHECK(result.out.empty());
    CHECK(contains(result.err, "[not_confirmed]"));
  }
  const Result ctrl_c = answered("\x03");
  CHECK(ctrl_c.status == 130);
  CHECK(contains(ctrl_c.err, "[interrupted]"));
}

TEST_CASE("commands that exclude each other are refused before anything is sent") {
  check_error(three_servos().run({"set", "-yn", "11", "command_angle=1deg", "command_speed=20rpm"}),
              2, "cross_check",
              "command_angle, command_speed and command_torque exclude each other\n"
              "  the servo obeys the last one: give just that");
}

TEST_CASE("a servo does not get the node ID of this process") {
  check_error(three_servos().run({"--local-node-id", "50", "set", "-n", "11", "static_node_id=50"}),
              2, "out_of_range", "static_node_id=50 is the node ID of this process");
}

TEST_CASE("the PWM output range is shown in the unit that the mode gives it") {
  const Result angle = three_servos().run({"set", "-yn", "11", "pwm_output_range=800raw"});
  CHECK(contains(angle.out, "700  (70.0 deg)  ->  800  (80.0 deg)  written\n"));
  const Result speed =
      three_servos().run({"set", "-yn", "11", "pwm_mode=speed", "pwm_output_range=80rpm"});
  CHECK(contains(speed.out, "700  (70.0 deg)  ->  80  (80 rpm)  written\n"));
}

TEST_CASE("set tells every fault of its arguments at once, and sends nothing") {
  const Result result =
      three_servos().run({"set", "-n", "11", "a=x", "b=y", "angle_limit_cw=90", "--json"});
  CHECK(result.status == 2);
  const auto errors = json(result.out)["errors"];
  REQUIRE(errors.size() == 3);
  CHECK(errors[0]["code"] == "unknown_parameter");
  CHECK(errors[1]["code"] == "unknown_parameter");
  CHECK(errors[2]["code"] == "usage");
}

TEST_CASE("who answers no gets no advice to agree beforehand") {
  const Result no = three_servos().run({"set", "-n", "11", "torque_output=off"},
                                       {.answers = {{"[y/N]", "n\n"}}, .terminal = true});
  CHECK(no.status == 7);
  CHECK_FALSE(contains(no.err, "--yes"));
  const Result pipe = three_servos().run({"set", "-n", "11", "torque_output=off"});
  CHECK(pipe.status == 7);
  CHECK(contains(pipe.err, "--yes"));
}

TEST_CASE("a model without PWM input holds 0 for it, and takes it") {
  const Result zeros = three_servos().run({"set", "-n", "12", "pwm_neutral=0us", "pwm_range=0us",
                                           "pwm_output_range=0deg", "pwm_mode=angle", "--json"});
  INFO(zeros.err);
  CHECK(zeros.status == 0);
  REQUIRE(changes(zeros).size() == 4);
  for (const auto& change : changes(zeros)) {
    CHECK(change["status"] == "unchanged");
  }
  check_error(three_servos().run({"set", "-n", "11", "pwm_neutral=0us"}), 2, "out_of_range",
              "node 11: pwm_neutral=0us: outside of the range 100us to 10000us");
}

TEST_CASE("a model without PWM input is spoken of as itself") {
  const Result result = three_servos().run({"set", "-n", "12", "pwm_neutral=1520us"});
  CHECK(result.status == 2);
  CHECK(codes(result) == std::vector<std::string>{"unsupported"});
  CHECK(contains(result.err, "has no PWM input: pwm_neutral (0x34) can only be 0\n  BLA15-"));
  CHECK_FALSE(contains(result.err, "BLA21"));
}
