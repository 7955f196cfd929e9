#include "blactl/sim/scenario/scenario.hpp"

#include "unit/sim/support.hpp"

#include <set>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::scenario;

namespace {

/// The message about a file that is wrong.
std::string faults(std::string_view text) {
  const auto parsed = parse_scenario(text, "line.json", testing::profiles());
  REQUIRE_FALSE(parsed);
  CHECK(parsed.error().code == Code::bad_file);
  return parsed.error().message;
}

/// The message about members of the one servo in a scenario; they stand on line 2.
std::string servo_faults(std::string_view members) {
  return faults(fmt::format("{{\"schema\": \"blactl-scenario/1\", \"servos\": [\n"
                            "{{{}}}]}}",
                            members));
}

bool has(const std::string& message, std::string_view part) {
  INFO(message);
  return message.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("the default scenario has three servos, each with identities of its own") {
  const auto standard = default_scenario(testing::profiles());
  REQUIRE(standard);
  REQUIRE(standard->servos.size() == 3);
  CHECK(standard->clock == Clock::real);
  CHECK(standard->foreign.empty());
  std::set<dronecan::UniqueId> unique_ids;
  std::set<std::int64_t> serial_numbers;
  for (const ServoSetup& servo : standard->servos) {
    unique_ids.insert(servo.unique_id);
    serial_numbers.insert(servo.serial_number);
  }
  CHECK(unique_ids.size() == 3);
  CHECK(serial_numbers.size() == 3);
  const ServoSetup& last = standard->servos[2];
  CHECK(last.profile->model == "BLA34-28U-AB");
  CHECK(last.node_id == 13);
  CHECK(last.servo_id == 3);
  CHECK(last.firmware_version == 1500);
  CHECK(standard->servos[0].firmware_version == 1400);
  CHECK(standard->servos[0].hardware_version == 12050);
}

TEST_CASE("a scenario says all there is to say") {
  const Scenario all = scenario(R"("clock": "virtual", "seed": 7, "servos": [{
      "model": "BLA21-12U-AB", "node_id": 11, "unique_id": "00112233445566778899AABBccddeeff",
      "serial_number": 240900558, "servo_id": 254, "firmware_version": 1300,
      "model_number": 60, "hardware_version": 12051, "name": "x", "answer_delay": "0.5ms",
      "rom": {"angle_limit_ccw": "-90deg", "0x21": 0},
      "ram": {"angle_limit_cw": "90deg", "0x39": -450, "torque_output": "brake",
              "current_voltage": "11.8V", "fault_warning": 16, "production_year": 2024},
      "behaviour": {"out_of_range": "clamp", "reserved_reads": "zero", "gated_reads": "zero",
                    "write_only_reads": "zero", "index_only_access": false,
                    "failure_with_name": true, "ignores_disabled_commands": false,
                    "answers_save_first": false, "rom_write_time": "80ms",
                    "not_a_number": "zero", "unused_fields": "zero",
                    "slow_speed": "turns_slowest", "array_command_shows": false,
                    "array_command_feeds_timeout": false,
                    "get_set_feeds_timeout": true, "inclusive_limits": false,
                    "failures_latch": true, "notices_warn": true, "pwm_end_points_move": false,
                    "pwm_waits_after_start": true, "boost_in_dead_band": true,
                    "soft_start_shows": true, "soft_start_resumes": true,
                    "start_angle": "zero", "assignment_shows": true, "first_node_status": "0.5s",
                    "beyond_unitless": "ignore", "timeout_beats_brake": true,
                    "keeps_disabled_command": false, "keeps_limited_angle": false,
                    "erase_holds": false, "speed_control_before_1100": true,
                    "inclusive_stops": true, "restart_bits_stop": true,
                    "pwm_yields_to_all": false, "output_write_ends_soft_start": false,
                    "erase_clears_rom": true, "obeys_servo_id_0": false,
                    "settings_wait_for_start": true, "restart_keeps_failures": true,
                    "array_out_of_range": "clamp", "reverse_turns_origin": true,
                    "soft_start_keeps_speed": true, "command_at_limit_notifies": true},
      "faults": {"no_node_status": true, "no_actuator_status": true,
                 "restart_after_answer": [{"to": "write", "number": 7}, {}], "lose_responses": 2, "mute": true, "lose_opcode_answers": 3,
                 "ignore_opcodes": 4, "refuse_opcodes": true, "rom_write_fails": true,
                 "stays": true, "never_returns": true, "restart_instead_of_answer": 5,
                 "power_loss_in_save": "0s", "return_delay": "3s"}}],
    "foreign": [{"kind": "node", "node_id": 30, "name": "org.example", "serves_get_set": true,
      "commands": {"servo_ids": [1, 255], "type": 3, "value": 60, "rate": 100}, "armed": false}])");
  CHECK(all.clock == Clock::simulated);
  CHECK(all.seed == 7);
  const ServoSetup& servo = all.servos.at(0);
  CHECK(servo.unique_id[10] == 0xAA);
  CHECK(servo.serial_number == 240900558);
  CHECK(servo.hardware_version == 12051);
  CHECK(servo.behaviour.answer_delay == 500us);
  CHECK(servo.ram[0] == std::pair(bla::address::angle_limit_cw, std::int64_t{900}));
  CHECK(servo.ram[1].second == -450);
  CHECK(servo.ram[2].second == 2);
  CHECK(servo.ram[3].second == 118);
  CHECK(servo.behaviour.out_of_range == OutOfRange::clamp);
  CHECK(servo.behaviour.gated_reads == MissingRead::zero);
  CHECK_FALSE(servo.behaviour.index_only_access);
  CHECK(servo.behaviour.failure_with_name);
  CHECK(servo.faults.lose_responses == 2);
  CHECK(servo.faults.mute);
  REQUIRE(servo.rom.size() == 2);
  CHECK(servo.rom[0] == std::pair(bla::address::angle_limit_ccw, std::int64_t{-900}));
  CHECK(servo.rom[1] == std::pair(bla::Address(0x21), std::int64_t{0}));
  CHECK_FALSE(servo.behaviour.answers_save_first);
  CHECK(servo.behaviour.rom_write_time == 80ms);
  CHECK(servo.behaviour.not_a_number == NotANumber::zero);
  CHECK(servo.behaviour.unused_fields == UnusedFields::zero);
  CHECK(servo.behaviour.slow_speed == SlowSpeed::turns_slowest);
  CHECK_FALSE(servo.behaviour.array_command_shows);
  CHECK_FALSE(servo.behaviour.array_command_feeds_timeout);
  CHECK(servo.behaviour.get_set_feeds_timeout);
  CHECK_FALSE(servo.behaviour.inclusive_limits);
  CHECK(servo.behaviour.failures_latch);
  CHECK(servo.behaviour.notices_warn);
  CHECK_FALSE(servo.behaviour.pwm_end_points_move);
  CHECK(servo.behaviour.pwm_waits_after_start);
  CHECK(servo.behaviour.boost_in_dead_band);
  CHECK(servo.behaviour.soft_start_shows);
  CHECK(servo.behaviour.soft_start_resumes);
  CHECK(servo.behaviour.start_angle == StartAngle::zero);
  CHECK(servo.behaviour.assignment_shows);
  CHECK(servo.behaviour.first_node_status == 500ms);
  CHECK(servo.behaviour.beyond_unitless == BeyondUnitless::ignore);
  CHECK(servo.behaviour.timeout_beats_brake);
  CHECK_FALSE(servo.behaviour.keeps_disabled_command);
  CHECK_FALSE(servo.behaviour.keeps_limited_angle);
  CHECK_FALSE(servo.behaviour.erase_holds);
  CHECK(servo.behaviour.speed_control_before_1100);
  CHECK(servo.behaviour.inclusive_stops);
  CHECK(servo.behaviour.restart_bits_stop);
  CHECK_FALSE(servo.behaviour.pwm_yields_to_all);
  CHECK_FALSE(servo.behaviour.output_write_ends_soft_start);
  CHECK(servo.behaviour.erase_clears_rom);
  CHECK_FALSE(servo.behaviour.obeys_servo_id_0);
  CHECK(servo.behaviour.settings_wait_for_start);
  CHECK(servo.behaviour.restart_keeps_failures);
  CHECK(servo.behaviour.array_out_of_range == ArrayOutOfRange::clamp);
  CHECK(servo.behaviour.reverse_turns_origin);
  CHECK(servo.behaviour.soft_start_keeps_speed);
  CHECK(servo.behaviour.command_at_limit_notifies);
  CHECK(servo.faults.no_node_status);
  CHECK(servo.faults.no_actuator_status);
  CHECK(servo.faults.restart_after_answer ==
        std::vector<RestartAfterAnswer>{{RequestKind::write, 7}, {RequestKind::any, 1}});
  CHECK(servo.faults.lose_opcode_answers == 3);
  CHECK(servo.faults.ignore_opcodes == 4);
  CHECK(servo.faults.refuse_opcodes);
  CHECK(servo.faults.rom_write_fails);
  CHECK(servo.faults.stays);
  CHECK(servo.faults.never_returns);
  CHECK(servo.faults.restart_instead_of_answer == 5);
  CHECK(servo.faults.power_loss_in_save == Duration::zero());
  CHECK(servo.faults.return_delay == 3s);
  const ForeignSetup& node = all.foreign.at(0);
  CHECK(node.node_id == 30);
  CHECK(node.serves_get_set);
  REQUIRE(node.commands);
  CHECK(node.commands->servo_ids == std::vector<std::uint8_t>{1, 255});
  CHECK(node.commands->period == 10ms);
  CHECK(node.armed == false);
}

TEST_CASE("a scenario says what goes wrong on the wire, and with what a servo sends") {
  const Scenario faulty = scenario(R"(
    "wire": {"loss": 0.5, "duplication": 0.25, "errors": 0.125, "bit_flips": 1,
             "burst_interval": "2s", "burst_length": "3ms"},
    "servos": [{"model": "BLA21-12U-AB", "sending": {"jitter": "2ms", "late_answers": 0.5,
                "late_by": "1500ms", "double_answers": 0.25}}])");
  CHECK(faulty.wire.loss == 0.5);
  CHECK(faulty.wire.duplication == 0.25);
  CHECK(faulty.wire.errors == 0.125);
  CHECK(faulty.wire.bit_flips == 1);
  CHECK(faulty.wire.burst_interval == std::chrono::seconds(2));
  CHECK(faulty.wire.burst_length == std::chrono::milliseconds(3));
  const SendingFaults& sending = faulty.servos.front().sending;
  CHECK(sending.jitter == std::chrono::milliseconds(2));
  CHECK(sending.late_answers == 0.5);
  CHECK(sending.late_by == std::chrono::milliseconds(1500));
  CHECK(sending.double_answers == 0.25);
}

TEST_CASE("left out, everything about a servo but its model has a likely value") {
  const ServoSetup servo = testing::servo_setup(R"("model": "BLA15-06U-A0")");
  CHECK(servo.node_id == 0);
  CHECK(servo.servo_id == 0);
  CHECK(servo.behaviour.answer_delay == 500us);
  CHECK(servo.model_number == 62);
  CHECK(servo.unique_id != dronecan::UniqueId{});
  CHECK(servo.name == "jp.co.futaba.bla15");
  CHECK(servo.rom.empty());
  CHECK(servo.behaviour.answers_save_first);
  CHECK(servo.behaviour.rom_write_time == 50ms);
  CHECK(servo.faults.return_delay == 0ms);
  CHECK_FALSE(servo.faults.never_returns);
  CHECK_FALSE(servo.faults.power_loss_in_save);
  // The unique ID follows the serial number.
  CHECK(servo.unique_id ==
        testing::servo_setup(R"("model": "BLA21-12U-AB", "serial_number": 240900001)").unique_id);
  CHECK(servo.unique_id !=
        testing::servo_setup(R"("model": "BLA21-12U-AB", "serial_number": 240900002)").unique_id);
}

TEST_CASE("an answer delay is a time in any unit, or a number of microseconds") {
  const auto delay = [](const char* value) {
    return testing::servo_setup(
               fmt::format(R"("model": "BLA21-12U-AB", "answer_delay": {})", value))
        .behaviour.answer_delay;
  };
  CHECK(delay("\"2ms\"") == 2ms);
  CHECK(delay("\"1.5s\"") == 1500ms);
  CHECK(delay("750") == 750us);
  CHECK(delay("0") == 0us);
}

TEST_CASE("every fault of a scenario is named with file, line, pointer and reason") {
  const std::string message = faults(R"({
  "schema": "blactl-scenario/1",
  "clock": "fast",
  "servos": [
    {"model": "BLA99"},
    {"node_id": 128, "model": "BLA21-12U-AB",
     "colour": "red"}
  ]
})");
  INFO(message);
  CHECK(has(message, "line.json:3: /clock: "));
  CHECK(has(message, "line.json:5: /servos/0/model: no model is called \"BLA99\"; there are "));
  CHECK(has(message, "BLA15-06U-A0"));
  CHECK(has(message, "line.json:6: /servos/1/node_id: "));
  CHECK(has(message, "line.json:7: /servos/1/colour: "));
}

TEST_CASE("faulty servos are told what is wrong with them") {
  const std::string model = R"("model": "BLA21-12U-AB", )";
  CHECK(has(servo_faults(""), "line.json:2: /servos/0"));
  CHECK(
      has(servo_faults(model + R"("unique_id": "0011")"), "/servos/0/unique_id: a unique ID has"));
  CHECK(has(servo_faults(model + R"("unique_id": "+0112233445566778899AABBccddeeff")"), "32"));
  CHECK(has(servo_faults(model + R"("servo_id": 255)"), "/servos/0/servo_id"));
  CHECK(has(servo_faults(model + R"("name": "")"), "/servos/0/name: a node name has"));
  CHECK(has(servo_faults(model + R"("answer_delay": "2min")"), "/servos/0/answer_delay"));
  CHECK(has(servo_faults(model + R"("answer_delay": "11s")"), "0 s to 10 s"));
  CHECK(has(servo_faults(model + R"("answer_delay": true)"), "a number or a string"));
  CHECK(has(servo_faults(model + R"("behaviour": {"out_of_range": "wrap"})"),
            "/servos/0/behaviour/out_of_range"));
  CHECK(has(servo_faults(model + R"("faults": {"lose_responses": -1})"),
            "/servos/0/faults/lose_responses"));
  CHECK(has(servo_faults(model + R"("faults": {"restart_after_answer": [{"to": "save"}]})"),
            "/servos/0/faults/restart_after_answer/0/to"));
  CHECK(has(servo_faults(model + R"("behaviour": {"first_node_status": "1.1s"})"),
            "/servos/0/behaviour/first_node_status: a time of 0 s to 1 s"));
  CHECK(has(servo_faults(model + R"("faults": {"loose_responses": 1})"),
            "/servos/0/faults/loose_responses"));
}

TEST_CASE("faulty values of registers are named by their key") {
  const auto ram = [](std::string_view member) {
    return servo_faults(fmt::format(R"("model": "BLA21-12U-AB", "ram": {{{}}})", member));
  };
  CHECK(has(ram(R"("angle_limit": 1)"), "/servos/0/ram/angle_limit: "));
  CHECK(has(ram(R"("angle_limit_cw": 90)"), "/servos/0/ram/angle_limit_cw: ")); // tenths: a unit
  CHECK(has(ram(R"("angle_limit_cw": "-1deg")"), "/servos/0/ram/angle_limit_cw: "));
  CHECK(has(ram(R"("torque_output": "loose")"), "/servos/0/ram/torque_output: "));
  CHECK(has(ram(R"("torque_output": null)"), "a number or a string"));
  CHECK(has(ram(R"("servo_id": 3)"), "is set by the key \"servo_id\""));
  CHECK(has(ram(R"("0x46": 3)"), "is set by the key \"node_id\""));
  CHECK(has(ram(R"("write_rom": 1)"), "holds no value"));
  CHECK(has(ram(R"("fault_summary": 1)"), "holds no value"));
  CHECK(has(ram(R"("pwm_output_range": "60rpm")"), "pwm_mode=1; this servo has pwm_mode=0"));
}

TEST_CASE("faulty values of ROM are named by their key") {
  const auto rom = [](std::string_view member) {
    return servo_faults(fmt::format(R"("model": "BLA15-06U-A0", "rom": {{{}}})", member));
  };
  CHECK(
      has(rom(R"("command_angle": 0)"), "/servos/0/rom/command_angle: command_angle is not kept"));
  CHECK(has(rom(R"("current_voltage": "7V")"), "is not kept in ROM"));
  CHECK(has(rom(R"("0x19": 0)"), "is not kept in ROM"));
  CHECK(has(rom(R"("production_year": 2024)"), "is not kept in ROM"));
  CHECK(has(rom(R"("bootloader": 0)"), "holds no value"));
  CHECK(has(rom(R"("0x46": 3)"), "is set by the key \"node_id\""));
  CHECK(has(rom(R"("angle_limit_cw": "-1deg")"), "/servos/0/rom/angle_limit_cw: "));
  CHECK(has(rom(R"("angle_limit": 1)"), "/servos/0/rom/angle_limit: "));
  CHECK(has(servo_faults(R"("model": "BLA21-12U-AB", "rom": 3)"), "/servos/0/rom"));
}

TEST_CASE("0x36 in rpm goes with the 0x37 of RAM, which comes from ROM unless it says otherwise") {
  const std::string model = R"("model": "BLA21-12U-AB", )";
  CHECK(testing::servo_setup(model + R"("rom": {"pwm_mode": "speed"},
                                        "ram": {"pwm_output_range": "60rpm"})")
            .ram.at(0)
            .second == 60);
  CHECK(has(servo_faults(model + R"("rom": {"pwm_output_range": "60rpm"},
                                    "ram": {"pwm_mode": "speed"})"),
            "/servos/0/rom/pwm_output_range"));
}

TEST_CASE("faulty times of a servo are named by their key") {
  const std::string model = R"("model": "BLA21-12U-AB", )";
  CHECK(has(servo_faults(model + R"("behaviour": {"rom_write_time": "11s"})"),
            "/servos/0/behaviour/rom_write_time: a time of 0 s to 10 s"));
  CHECK(has(servo_faults(model + R"("faults": {"return_delay": "601s"})"),
            "/servos/0/faults/return_delay: a time of 0 s to 600 s"));
  CHECK(has(servo_faults(model + R"("faults": {"return_delay": "-1s"})"), "0 s to 600 s"));
  CHECK(has(servo_faults(model + R"("faults": {"stays": 1})"), "/servos/0/faults/stays"));
}

TEST_CASE("0x36 in rpm goes with the 0x37 of the same servo, wherever that stands") {
  const ServoSetup servo = testing::servo_setup(
      R"("model": "BLA21-12U-AB", "ram": {"pwm_output_range": "60rpm", "pwm_mode": "speed"})");
  CHECK(servo.ram.at(0).second == 60);
}

TEST_CASE("faulty foreign nodes are told what is wrong with them") {
  const auto foreign = [](std::string_view members) {
    return faults(
        fmt::format("{{\"schema\": \"blactl-scenario/1\", \"foreign\": [{{{}}}]}}", members));
  };
  CHECK(has(foreign(R"("kind": "radio", "node_id": 1)"), "/foreign/0/kind"));
  CHECK(has(foreign(R"("kind": "node")"), "node_id"));
  CHECK(has(foreign(R"("kind": "node", "node_id": 0)"), "/foreign/0/node_id"));
  CHECK(has(foreign(R"("kind": "node", "node_id": 1, "commands": {"servo_ids": []})"), "1 to 15"));
  CHECK(has(foreign(R"("kind": "node", "node_id": 1, "commands": {"servo_ids": [256]})"),
            "/foreign/0/commands/servo_ids/0"));
  CHECK(has(foreign(R"("kind": "node", "node_id": 1, "commands": {"servo_ids": [1], "rate": 0})"),
            "/foreign/0/commands/rate"));
  CHECK(has(foreign(R"("kind": "node", "node_id": 1, "rate": 5)"), "/foreign/0/rate: this key"));
  CHECK(has(foreign(R"("kind": "gnss", "node_id": 1, "rate": 51)"), "/foreign/0/rate: "));
  CHECK(has(foreign(R"("kind": "esc", "node_id": 1, "index": 32)"), "/foreign/0/index: "));
  CHECK(has(foreign(R"("kind": "babbler", "node_id": 1, "load": 2)"), "/foreign/0/load: "));
}

TEST_CASE("faulty events are told what is wrong with them") {
  const auto faults = [](std::string_view event) {
    const auto parsed =
        parse_scenario(fmt::format(R"({{"schema": "blactl-scenario/1", "events": [{}],
                                        "servos": [{{"model": "BLA21-12U-AB"}}]}})",
                                   event),
                       "test.json", testing::profiles());
    REQUIRE_FALSE(parsed);
    return parsed.error().message;
  };
  CHECK(has(faults(R"({"at": "1s"})"), "/events/0: an event has"));
  CHECK(has(faults(R"({"at": "1s", "servo": 1, "world": {}})"), "/events/0/servo: no servo"));
  CHECK(has(faults(R"({"at": "1s", "clients": "gone"})"), "/events/0/clients"));
  const auto world = [&](std::string_view members) {
    return faults(fmt::format(R"({{"servo": 240900001, "world": {{{}}}}})", members));
  };
  CHECK(has(faults(R"({"servo": 240900001})"), "/events/0: an event of a servo has"));
  CHECK(has(faults(R"({"servo": 240900001, "happens": "fire"})"), "/events/0/happens"));
  CHECK(has(faults(R"({"clients": "cut", "happens": "power_off"})"), "/events/0/happens"));
  CHECK(has(world(R"("voltage": "5")"), "/events/0/world/voltage"));
  CHECK(has(world(R"("voltage": "60.1V")"), "60.0V"));
  CHECK(has(world(R"("voltages": "5V")"), "there are voltage, temperature, load, hand, pulse"));
  CHECK(has(world(R"("magnet": "off")"), "there are fine, weak, strong, unreadable"));
  CHECK(has(world(R"("stuck": true)"), "/events/0/world/stuck"));
}

TEST_CASE("events change one thing of the world each") {
  const Scenario with_events = scenario(R"("servos": [{"model": "BLA21-12U-AB"}], "events": [
    {"at": "1.5s", "servo": 240900001, "world": {"voltage": "5.5V", "temperature": "95degC",
     "load": "-30%", "hand": "45.0deg", "pulse": "1520us", "magnet": "weak", "stuck": "on",
     "driver_stopped": "on", "rotation_abnormal": "on", "plugged": "off"}},
    {"at": "3s", "servo": 240900001, "world": {"hand": "free", "pulse": "none"}}])");
  REQUIRE(with_events.events.size() == 2);
  CHECK(with_events.events[0].at == std::chrono::milliseconds(1500));
  World world;
  for (const WorldChange& change : with_events.events[0].changes) {
    change(world);
  }
  World expected;
  expected.supply_decivolt = 55;
  expected.board_celsius = 95;
  expected.load_percent = -30;
  expected.hand_decideg = 450;
  expected.pulse_us = 1520;
  expected.magnet = Magnet::weak;
  expected.stuck = expected.driver_stopped = expected.rotation_abnormal = true;
  expected.plugged = false;
  CHECK(world == expected);
  for (const WorldChange& change : with_events.events[1].changes) {
    change(world);
  }
  CHECK_FALSE(world.hand_decideg);
  CHECK_FALSE(world.pulse_us);
}

TEST_CASE("what is no scenario at all is said to be none") {
  CHECK(has(faults("["), "line.json:1"));
  CHECK(has(faults("[]"), "line.json:1"));
  CHECK(has(faults(R"({"schema": "blactl-fleet/1"})"), "/schema"));
  const auto absent = read_scenario("/nonexistent/scenario.json", testing::profiles());
  REQUIRE_FALSE(absent);
  CHECK(absent.error().code == Code::bad_file);
}
