// ROM, restarts and what goes wrong with them (sections 2.3, 4.9 to 4.11).

#include "unit/sim/servo_rig.hpp"

#include <set>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using namespace bla::address;
using dronecan::ExecuteOpcode;
using testing::bla21;
using testing::failed;
using testing::frame;
using testing::Frames;
using testing::only;
using testing::Rig;
using testing::uptimes;

namespace {

constexpr std::uint8_t save = ExecuteOpcode::save, erase = ExecuteOpcode::erase;

using Uptimes = std::vector<std::pair<std::uint32_t, unsigned>>;

std::string with(const std::string& members) {
  return std::string(bla21) + ", " + members;
}

} // namespace

TEST_CASE("requirements 50, 57: SAVE is answered with argument 0 and ok, 7 bytes",
          "[requirement-50][requirement-57]") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E0A8BFF#00000000000000C1")}) == Frames{"1E0A7F8B#00000000000080C1"});
}

TEST_CASE("requirement 50: the argument of ExecuteOpcode does not matter", "[requirement-50]") {
  Rig rig(bla21);
  CHECK(rig.opcode(save, -1) == "ok");
  rig.settle();
  CHECK(rig.servo.rom_writes() == 1);
}

TEST_CASE("requirement 51: opcodes other than SAVE and ERASE are refused and do nothing",
          "[requirement-51]") {
  Rig rig(with(R"("ram": {"reverse": "on"})"));
  for (const std::uint8_t opcode : std::initializer_list<std::uint8_t>{2, 7, 255}) {
    CHECK(rig.opcode(opcode) == "refused");
  }
  CHECK(rig.bench.ask({frame("1E0A8BFF#02000000000000D5")}) == Frames{"1E0A7F8B#00000000000000D5"});
  rig.bench.run(1s);
  CHECK(rig.events.empty());
  CHECK(rig.ram(reverse) == 1);
}

TEST_CASE("requirements 42, 43: RestartNode with the magic number restarts, with another it fails",
          "[requirement-42][requirement-43]") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E058BFF#1E1B55CEABC9")}) == Frames{"1E057F8B#00C9"});
  CHECK(rig.restart_node(0) == "refused");
  CHECK(rig.events.empty());
  CHECK(rig.bench.ask({frame("1E058BFF#1E1B55CEACC3")}) == Frames{"1E057F8B#80C3"});
  CHECK(rig.told() == Frames{"restart 11"});
  CHECK(rig.servo.rom_writes() == 0);
  CHECK(rig.bench.ask({frame("1E058BFF#1E1B55CEC4")}).empty()); // too short, and it is down
}

TEST_CASE("requirement 44: 1 written to 0x11 restarts, 0 does nothing", "[requirement-44]") {
  Rig rig(bla21);
  CHECK(rig.write("0x11", 0) == 0);
  CHECK(rig.write("0x11", 2) == 0); // out of range
  CHECK(rig.events.empty());
  CHECK(rig.write("0x11", 1) == 1);
  CHECK(rig.told() == Frames{"restart 11"});
  rig.settle();
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));
  CHECK(rig.servo.rom_writes() == 0);
}

TEST_CASE("requirement 44: 0 written to 0x10 and 0x12 does nothing, reading them fails",
          "[requirement-44]") {
  Rig rig(with(R"("ram": {"reverse": "on"})"));
  CHECK(rig.write("0x10", 0) == 0);
  CHECK(rig.write("0x12", 0) == 0);
  CHECK_FALSE(rig.read("0x12"));
  rig.bench.run(1s);
  CHECK(rig.events.empty());
  CHECK(rig.ram(reverse) == 1);
}

TEST_CASE("requirement 17: uptime and transfer IDs begin anew with a restart", "[requirement-17]") {
  Rig rig(bla21, 0ms);
  CHECK(uptimes(rig.bench.run(2500ms)) == Uptimes{{0, 0}, {1, 1}, {2, 2}});
  CHECK(rig.restart_node() == "ok");
  CHECK(uptimes(rig.bench.run(1500ms)) == Uptimes{{0, 0}, {1, 1}});
}

TEST_CASE("requirement 45: a restart brings back what ROM holds, and the commands of power-on",
          "[requirement-45]") {
  Rig rig(with(R"("rom": {"angle_limit_cw": "90deg"}, "ram": {"reverse": "on"})"));
  CHECK(rig.ram(angle_limit_cw) == 900); // RAM comes from ROM
  CHECK(rig.rom(reverse) == 0);          // "ram" is not saved
  CHECK(rig.write("0x38", 450) == 450);
  CHECK(rig.write("0x00", 300) == 300);
  CHECK(rig.ram(command_speed) == bla::not_active);
  CHECK(rig.rom(angle_limit_cw) == 900);
  CHECK(rig.restart_node() == "ok");
  rig.settle();
  CHECK(rig.ram(angle_limit_cw) == 900);
  CHECK(rig.ram(reverse) == 0);
  CHECK(rig.ram(servo_id) == 1);
  CHECK(rig.ram(command_angle) == 0);
  CHECK(rig.ram(command_speed) == 0);
}

TEST_CASE("requirement 45: what is measured, what is wrong and who it is survive a restart",
          "[requirement-45]") {
  Rig rig(with(R"("serial_number": 7, "ram": {"current_voltage": "11.8V", "fault_warning": 16,
                  "production_year": 2024})"));
  CHECK(rig.restart_node() == "ok");
  rig.settle();
  CHECK(rig.ram(bla::Address(0x0C)) == 118);
  CHECK(rig.ram(bla::Address(0x1A)) == 16);
  CHECK(rig.ram(bla::Address(0x58)) == 2024);
  CHECK(rig.ram(serial_number) == 7);
}

TEST_CASE("requirement 46: a restart brings the angle back within one turn", "[requirement-46]") {
  const auto after_restart = [](const char* angle) {
    Rig rig(with(
        fmt::format(R"("ram": {{"current_angle": "{}"}}, "rom": {{"soft_start": "off"}})", angle)));
    CHECK(rig.restart_node() == "ok");
    rig.settle();
    return rig.ram(current_angle);
  };
  CHECK(after_restart("270deg") == -900);
  CHECK(after_restart("-270deg") == 900);
  CHECK(after_restart("179.9deg") == 1799);
  CHECK(after_restart("180deg") == -1800);
  CHECK(after_restart("-180deg") == -1800);
  CHECK(after_restart("-180.1deg") == 1799);
  CHECK(after_restart("3645deg") == 450);
}

TEST_CASE("requirement 49: a changed 0x46 is the address after save and restart, not before",
          "[requirement-49]") {
  Rig rig(bla21);
  CHECK(rig.write("0x46", 40) == 40);
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));
  CHECK(rig.restart_node() == "ok");
  rig.settle();
  CHECK(rig.servo.node_id() == dronecan::NodeId(11)); // it was not saved
  CHECK(rig.write("0x46", 40) == 40);
  CHECK(rig.opcode(save) == "ok");
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));
  rig.settle();
  CHECK(rig.servo.node_id() == dronecan::NodeId(40));
  CHECK(rig.read("0x46") == 40);
}

TEST_CASE("requirements 52, 55, 60: SAVE and 0x12 write ROM and restart, GetSet alone does not",
          "[requirement-52][requirement-55][requirement-60]") {
  for (const bool by_register : {false, true}) {
    Rig rig(bla21);
    CHECK(rig.write("0x38", 450) == 450);
    CHECK(rig.rom(angle_limit_cw) == 1799);
    if (by_register) {
      CHECK(rig.write("0x12", 1) == 1);
    } else {
      CHECK(rig.opcode(save) == "ok");
    }
    const auto frames = rig.settle();
    CHECK(rig.rom(angle_limit_cw) == 450);
    CHECK(rig.ram(angle_limit_cw) == 450);
    CHECK(rig.servo.rom_writes() == 1);
    CHECK(rig.told() == Frames{"rom_write 11", "restart 11"});
    CHECK(uptimes(frames) == Uptimes{{0, 0}});
  }
}

TEST_CASE("requirement 54: for 50 ms, and while it starts, a saving servo is silent",
          "[requirement-54]") {
  Rig rig(bla21);
  const Time asked = rig.bench.now();
  CHECK(rig.opcode(save) == "ok"); // a millisecond goes by
  CHECK(rig.bench.run(48ms).empty());
  CHECK(rig.servo.rom_writes() == 0);
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));
  CHECK_FALSE(rig.read("0x38"));
  CHECK(rig.bench.run(49ms).empty());
  CHECK(rig.servo.rom_writes() == 1);
  REQUIRE(rig.events.size() == 2);
  CHECK(rig.events[0].at == asked + 50ms);
  CHECK_FALSE(rig.read("0x38")); // it starts for 50 to 150 ms
  CHECK_FALSE(rig.settle().empty());
  CHECK(rig.read("0x38") == 1799);
}

TEST_CASE("requirement 54: how long a ROM write takes can be set", "[requirement-54]") {
  Rig rig(with(R"("behaviour": {"rom_write_time": "2s"})"));
  CHECK(rig.opcode(save) == "ok");
  CHECK(rig.bench.run(2s - 2ms).empty());
  CHECK(rig.events.empty());
  CHECK_FALSE(rig.settle().empty());
}

TEST_CASE("requirement 56: 0x20 to 0x4F are saved, the commands and what is fixed are not",
          "[requirement-56]") {
  Rig rig(with(R"("ram": {"reverse": "on"})"));
  CHECK(rig.write("0x00", 300) == 300);
  CHECK(rig.write("0x45", 9) == 9);
  CHECK(rig.opcode(save) == "ok");
  rig.settle();
  CHECK(rig.ram(command_angle) == 0);
  CHECK(rig.rom(reverse) == 1);
  CHECK(rig.rom(servo_id) == 9);
  CHECK(rig.rom(command_angle) == 0);
  CHECK(rig.rom(model_number) == 0);
  for (const bla::Parameter& parameter : testing::profiles().all().front().parameters) {
    const bool in_rom = parameter.address.value() >= 0x20 && parameter.address.value() < 0x50;
    CHECK(parameter.saved == in_rom);
  }
}

TEST_CASE("requirement 57: the answer to SAVE comes first, unless the servo is set to give none",
          "[requirement-57][unproven]") {
  Rig first(bla21);
  CHECK(first.opcode(save) == "ok");
  CHECK(first.events.empty());
  Rig none(with(R"("behaviour": {"answers_save_first": false})"));
  CHECK(none.opcode(save) == "silence");
  for (const can::Frame& one : none.settle()) {
    CHECK(dronecan::decode_id(one.id)->kind == dronecan::Kind::message);
  }
  CHECK(none.servo.rom_writes() == 1);
  CHECK_FALSE(none.write("0x12", 1));
  none.settle();
  CHECK(none.servo.rom_writes() == 2);
  CHECK(none.restart_node() == "ok"); // it is about saving only
}

TEST_CASE("requirement 57: answers of before come with the answer to SAVE, none comes after it",
          "[requirement-57]") {
  Rig rig(R"("model": "BLA21-12U-AB", "node_id": 11, "answer_delay": "2ms")");
  const can::Frame read = frame("1E0B8BFF#000030783338C5");
  const can::Frame opcode = frame("1E0A8BFF#00000000000000C1");
  const can::Frame late = frame("1E0B8BFF#000030783338C6");
  const Frames answers = rig.bench.ask({read, opcode, late}, 300ms);
  REQUIRE(answers.size() == 4);
  CHECK(answers[2] == "1E0B7F8B#3078333845");
  CHECK(answers[3] == "1E0A7F8B#00000000000080C1");
}

TEST_CASE("a restart forgets the answers that were still to come") {
  Rig rig(R"("model": "BLA21-12U-AB", "node_id": 11, "answer_delay": "300ms",
             "behaviour": {"answers_save_first": false})");
  const Frames answers =
      rig.bench.ask({frame("1E0B8BFF#000030783338C5"), frame("1E0A8BFF#00000000000000C1")}, 2s);
  CHECK(answers.empty());
  CHECK(rig.servo.rom_writes() == 1);
}

TEST_CASE("requirements 53, 61: ERASE and 0x10 bring defaults to RAM, IDs included, not to ROM",
          "[requirement-53][requirement-61]") {
  for (const bool by_register : {false, true}) {
    Rig rig(with(R"("rom": {"angle_limit_cw": "90deg"}, "ram": {"current_voltage": "11.8V"})"));
    CHECK(rig.write("0x00", 300) == 300);
    if (by_register) {
      CHECK(rig.write("0x10", 1) == 1);
    } else {
      CHECK(rig.opcode(erase) == "ok");
    }
    for (const bla::Parameter& parameter : testing::servo_setup(bla21).profile->parameters) {
      if (parameter.access == bla::Access::read_write) {
        INFO(parameter.name);
        CHECK(rig.ram(parameter.address) == parameter.default_raw.value_or(-1));
      }
    }
    CHECK(rig.ram(servo_id) == 0);
    CHECK(rig.ram(static_node_id) == 0);
    CHECK(rig.ram(serial_number) != 0);
    CHECK(rig.ram(bla::Address(0x0C)) == 118);
    CHECK(rig.rom(angle_limit_cw) == 900);
    CHECK(rig.rom(static_node_id) == 11);
    CHECK(rig.told() == Frames{"erase 11"});
    CHECK(rig.servo.rom_writes() == 0);
    // It goes on where it was, under the address that it has.
    CHECK(rig.read("0x46") == 0);
    CHECK(uptimes(rig.bench.run(1s)) == Uptimes{{1, 1}});
  }
}

TEST_CASE("requirement 62: a restart after ERASE without SAVE brings the old values back",
          "[requirement-62]") {
  Rig rig(with(R"("rom": {"angle_limit_cw": "90deg"})"));
  CHECK(rig.opcode(erase) == "ok");
  CHECK(rig.write("0x11", 1) == 1);
  rig.settle();
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));
  CHECK(rig.read("0x38") == 900);
  CHECK(rig.read("0x45") == 1);
}

TEST_CASE("requirements 27, 63: ERASE, then SAVE: the defaults stay, and the servo asks for an ID",
          "[requirement-27][requirement-63]") {
  Rig rig(with(R"("rom": {"angle_limit_cw": "90deg"})"));
  CHECK(rig.write("0x10", 1) == 1);
  CHECK(rig.write("0x12", 1) == 1);
  rig.settle();
  CHECK(rig.servo.node_id() == dronecan::anonymous);
  CHECK(rig.rom(static_node_id) == 0);
  CHECK(rig.rom(servo_id) == 0);
  CHECK(rig.rom(angle_limit_cw) == 1799);
  const auto frames = rig.bench.run(1100ms);
  REQUIRE_FALSE(frames.empty());
  for (const can::Frame& one : frames) {
    CHECK(one.id == frames.front().id);
    CHECK(testing::text(one).substr(8, 15) == "#01001122334455");
  }
  rig.allocate(125);
  CHECK(rig.servo.node_id() == dronecan::NodeId(125));
  CHECK(rig.told() == Frames{"erase 11", "rom_write 11", "restart 11", "allocated 125"});
}

TEST_CASE("requirements 28, 40: an allocated ID is gone with a restart, another may follow",
          "[requirement-28][requirement-40]") {
  Rig rig(R"("model": "BLA21-12U-AB", "answer_delay": 0)", 0ms);
  rig.allocate(125);
  CHECK(rig.restart_node() == "ok");
  CHECK(rig.servo.node_id() == dronecan::anonymous);
  rig.settle();
  CHECK_FALSE(rig.read("0x38"));
  rig.allocate(124);
  CHECK(rig.servo.node_id() == dronecan::NodeId(124));
  CHECK(uptimes(rig.bench.run(10ms)).at(0).second == 0);
  CHECK(rig.told() == Frames{"allocated 125", "restart 125", "allocated 124"});
}

TEST_CASE("requirement 29: each restart has a boot time and allocation times of its own",
          "[requirement-29]") {
  Rig rig(bla21);
  std::set<Duration> boot_times;
  for (int i = 0; i < 5; ++i) {
    CHECK(rig.restart_node() == "ok");
    const Time down = rig.events.back().at;
    while (rig.bench.run(1us).empty()) {
    }
    boot_times.insert(rig.bench.now() - down);
    CHECK(rig.bench.now() - down >= 50ms);
    CHECK(rig.bench.now() - down <= 151ms);
  }
  CHECK(boot_times.size() >= 4);
}

TEST_CASE("an event says who, when, and how often ROM was written") {
  Rig rig(with(R"("serial_number": 240900007)"));
  for (int i = 0; i < 2; ++i) {
    CHECK(rig.opcode(save) == "ok");
    rig.settle();
  }
  REQUIRE(rig.events.size() == 4);
  const ServoEvent& last = rig.events[2];
  CHECK(last.kind == ServoEvent::Kind::rom_write);
  CHECK(last.at == Time{} + 200ms + 1ms + 210ms + 50ms);
  CHECK(last.unique_id == rig.servo.unique_id());
  CHECK(last.serial_number == 240900007);
  CHECK(last.node_id == dronecan::NodeId(11));
  CHECK(last.rom_writes == 2);
  CHECK(rig.servo.rom_writes() == 2);
}

TEST_CASE("faults: the first answers to orders are lost, the orders are obeyed") {
  Rig rig(with(R"("faults": {"lose_opcode_answers": 2})"));
  CHECK(rig.read("0x38") == 1799); // no order
  CHECK(rig.opcode(9) == "refused");
  CHECK_FALSE(rig.write("0x10", 1));
  CHECK(rig.ram(servo_id) == 0);
  CHECK(rig.opcode(save) == "silence");
  rig.settle();
  CHECK(rig.servo.rom_writes() == 1);
  Rig third(with(R"("faults": {"lose_opcode_answers": 1})"));
  CHECK(third.restart_node() == "silence");
  third.settle();
  CHECK(third.told() == Frames{"restart 11"});
  CHECK(third.restart_node() == "ok");
}

TEST_CASE("faults: the first orders are neither obeyed nor answered") {
  Rig rig(with(R"("faults": {"ignore_opcodes": 3})"));
  CHECK(rig.write("0x11", 0) == 0); // no order
  CHECK(rig.opcode(save) == "silence");
  CHECK(rig.restart_node() == "silence");
  CHECK_FALSE(rig.write("0x10", 1));
  CHECK(rig.events.empty());
  CHECK(rig.ram(servo_id) == 1);
  CHECK(rig.opcode(save) == "ok");
  rig.settle();
  CHECK(rig.servo.rom_writes() == 1);
}

TEST_CASE("faults: a servo that refuses says so, and does nothing") {
  Rig rig(with(R"("faults": {"refuse_opcodes": true})"));
  CHECK(rig.opcode(save) == "refused");
  CHECK(rig.opcode(erase) == "refused");
  CHECK(rig.restart_node() == "refused");
  for (const char* name : {"0x10", "0x11", "0x12"}) {
    CHECK(failed(rig.answered(rig.get_set(0, std::int64_t{1}, name))));
  }
  CHECK(rig.write("0x38", 900) == 900);
  rig.bench.run(1s);
  CHECK(rig.events.empty());
}

TEST_CASE("faults: a failed ROM write shows only in the values after the restart") {
  Rig rig(with(R"("faults": {"rom_write_fails": true})"));
  CHECK(rig.write("0x38", 900) == 900);
  CHECK(rig.opcode(save) == "ok");
  rig.settle();
  CHECK(rig.read("0x38") == 1799);
  CHECK(rig.servo.rom_writes() == 1);
  CHECK(rig.told() == Frames{"rom_write 11", "restart 11"});
}

TEST_CASE("faults: a servo that stays answers ok, saves and runs on") {
  Rig rig(with(R"("faults": {"stays": true})"));
  CHECK(rig.write("0x38", 900) == 900);
  CHECK(rig.restart_node() == "ok");
  CHECK(rig.opcode(save) == "ok");
  CHECK(rig.bench.run(48ms).empty());
  rig.bench.run(2s);
  CHECK(rig.read("0x38") == 900);
  CHECK(rig.rom(angle_limit_cw) == 900);
  CHECK(rig.told() == Frames{"rom_write 11"});
  CHECK(uptimes(rig.bench.run(1s)) == Uptimes{{3, 3}});
}

TEST_CASE("faults: after a long silence a servo that stays does not send what it missed") {
  Rig rig(with(R"("faults": {"stays": true}, "behaviour": {"rom_write_time": "5s"})"));
  CHECK(rig.opcode(save) == "ok");
  const auto frames = rig.bench.run(5050ms);
  CHECK(only(frames, dronecan::NodeStatus::type.id).size() == 1);
  CHECK(only(frames, dronecan::ActuatorStatus::type.id).size() == 2); // one of two frames
}

TEST_CASE("faults: a servo can be dead after its first restart") {
  Rig rig(with(R"("faults": {"never_returns": true})"));
  CHECK(rig.read("0x38") == 1799);
  CHECK(rig.opcode(save) == "ok");
  CHECK(rig.bench.run(1h).empty());
  CHECK(rig.servo.next_deadline() == never);
  CHECK(rig.told() == Frames{"rom_write 11", "restart 11"});
}

TEST_CASE("faults: a servo can take its time to return, but not at power-on") {
  Rig rig(with(R"("faults": {"return_delay": "3s"})"));
  CHECK(rig.read("0x38") == 1799);
  CHECK(rig.restart_node() == "ok");
  CHECK(rig.bench.run(3s).empty());
  CHECK(uptimes(rig.bench.run(200ms)) == Uptimes{{0, 0}});
}

TEST_CASE("faults: a servo can restart instead of answering one request") {
  Rig rig(with(R"("faults": {"restart_instead_of_answer": 3})"));
  CHECK(rig.read("0x38") == 1799);
  CHECK(rig.write("0x38", 900) == 900);
  CHECK(rig.opcode(save) == "silence");
  CHECK(rig.told() == Frames{"restart 11"});
  rig.settle();
  CHECK(rig.servo.rom_writes() == 0);
  CHECK(rig.read("0x38") == 1799);
  CHECK(rig.opcode(save) == "ok");
}

TEST_CASE("faults: a supply that blinks while ROM is written leaves initial values, once",
          "[requirement-65]") {
  for (const char* moment : {"0s", "1ms", "49ms"}) {
    Rig rig(with(R"("rom": {"angle_limit_cw": "45deg"}, "faults": {"power_loss_in_save": ")" +
                 std::string(moment) + R"("})"));
    CHECK(rig.write("0x39", -900) == -900);
    CHECK(rig.opcode(save) == "ok");
    rig.settle();
    CHECK(rig.told() == Frames{"rom_write 11", "restart 11"});
    CHECK(rig.ram(bla::Address(0x38)) == 1799);
    CHECK((rig.ram(bla::Address(0x1A)) & (1 << 15)) != 0);
    CHECK(rig.ram(static_node_id) == 0); // it asks for an ID now
  }
}

TEST_CASE("faults: a mute servo obeys") {
  Rig rig(with(R"("faults": {"mute": true})"));
  CHECK(rig.opcode(save) == "silence");
  rig.settle();
  CHECK(rig.servo.rom_writes() == 1);
}

TEST_CASE("faults: a servo that clamps takes 2 for 1, one that refuses does not") {
  Rig refusing(bla21);
  CHECK(refusing.write("0x12", 2) == 0);
  Rig clamping(with(R"("behaviour": {"out_of_range": "clamp"})"));
  CHECK(clamping.write("0x12", 2) == 1);
  refusing.settle();
  clamping.settle();
  CHECK(refusing.servo.rom_writes() == 0);
  CHECK(clamping.servo.rom_writes() == 1);
}
