// Motion as the bus sees it: ArrayCommand, actuator.Status, health, loss of power.

#include "blactl/sim/servo/servo.hpp"

#include "sim/servo/names.hpp"
#include "unit/sim/servo_rig.hpp"

#include <limits>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using dronecan::ArrayCommand;
using testing::frame;
using testing::Frames;
using testing::only;
using testing::Rig;

namespace {

constexpr const char* calm = R"("model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1,
    "answer_delay": 0, "rom": {"soft_start": "off", "timeout_action": "hold"})";

std::string with(const std::string& members) {
  return std::string(calm) + ", " + members;
}

void send(Rig& rig, const std::vector<ArrayCommand::Command>& commands) {
  ArrayCommand message;
  message.commands = commands;
  const dronecan::Header header{dronecan::Kind::message, 16, ArrayCommand::type.id,
                                dronecan::NodeId(127),   {}, 0};
  rig.id = static_cast<dronecan::TransferId>((rig.id + 1) % dronecan::transfer_id_modulus);
  rig.bench.deliver(
      dronecan::segment(header, rig.id, ArrayCommand::type.signature, message.encode().bytes()));
}

std::int64_t value(Rig& rig, bla::Address address) {
  rig.servo.look(rig.bench.now());
  return rig.ram(address);
}

void around(Rig& rig, void (*change)(World&)) {
  World world = rig.servo.world();
  change(world);
  rig.servo.surround(world, rig.bench.now());
}

/// Health of the last NodeStatus within the next 1.1 s.
unsigned health(Rig& rig) {
  return only(rig.bench.run(1100ms), dronecan::NodeStatus::type.id).back().data[4] >> 6U;
}

} // namespace

TEST_CASE("requirements 96, 97, 103, 110: ArrayCommand as it is on the wire",
          "[requirement-96][requirement-97][requirement-103][requirement-110]") {
  Rig rig(calm);
  // One command: id 1, type 1, 0.45 as float16; one frame, without a length.
  rig.bench.deliver({frame("1003F27F#01013337C0")});
  CHECK(value(rig, address::command_angle) == 450);
  rig.bench.run(2s);
  CHECK(std::abs(value(rig, address::current_angle) - 450) <= 5);
}

TEST_CASE("requirements 96, 98: of 15 commands it obeys those with its ID, and 255",
          "[requirement-96][requirement-98]") {
  Rig rig(calm);
  std::vector<ArrayCommand::Command> commands;
  for (std::uint8_t id = 15; id >= 1; --id) {
    commands.push_back({id, 1, static_cast<float>(id) / 100});
  }
  send(rig, commands);
  CHECK(value(rig, address::command_angle) == 10);
  send(rig, {{2, 1, 0.5F}, {0, 1, 0.5F}});
  CHECK(value(rig, address::command_angle) == 10);
  send(rig, {{255, 1, -0.25F}});
  CHECK(value(rig, address::command_angle) == -250);
}

TEST_CASE("requirement 99: two servos with one ID both obey", "[requirement-99]") {
  for (const char* node : {"11", "12"}) {
    Rig rig(fmt::format(R"("model": "BLA21-12U-AB", "node_id": {}, "servo_id": 7)", node));
    send(rig, {{7, 1, 0.1F}});
    CHECK(value(rig, address::command_angle) == 100);
  }
}

TEST_CASE("requirements 105, 106: ArrayCommand writes 0x00 to 0x02 as GetSet does",
          "[requirement-105][requirement-106]") {
  Rig rig(calm);
  send(rig, {{1, 3, 60}});
  CHECK(value(rig, address::command_speed) == 0); // without 0x25
  send(rig, {{1, 2, 60}});
  CHECK(value(rig, address::command_torque) == 0);
  CHECK(rig.write("0x25", 1) == 1);
  send(rig, {{1, 3, 60}});
  CHECK(value(rig, address::command_speed) == 60);
  CHECK(value(rig, address::command_angle) == bla::not_active);
  send(rig, {{1, 2, -20}});
  CHECK(value(rig, address::command_torque) == -20);
  CHECK(value(rig, address::command_speed) == bla::not_active);
  send(rig, {{1, 3, 301}}); // out of range: as GetSet
  CHECK(value(rig, address::command_torque) == -20);
}

TEST_CASE("requirements 104, 107: unknown types and what is no number leave everything as it was",
          "[requirement-104][requirement-107]") {
  Rig rig(calm);
  send(rig, {{1, 1, 0.1F}});
  send(rig, {{1, 4, 0.5F},
             {1, 255, 0.5F},
             {1, 1, std::numeric_limits<float>::quiet_NaN()},
             {1, 1, std::numeric_limits<float>::infinity()}});
  CHECK(value(rig, address::command_angle) == 100);
}

TEST_CASE("requirement 107: a servo may take what is no number for 0",
          "[requirement-107][unproven]") {
  Rig rig(with(R"("behaviour": {"not_a_number": "zero"})"));
  send(rig, {{1, 1, 0.1F}});
  send(rig, {{1, 1, std::numeric_limits<float>::quiet_NaN()}});
  CHECK(value(rig, address::command_angle) == 0);
}

TEST_CASE("requirement 28: without a node ID it obeys no ArrayCommand", "[requirement-28]") {
  Rig rig(R"("model": "BLA21-12U-AB", "servo_id": 1)");
  send(rig, {{1, 1, 0.1F}});
  CHECK(value(rig, address::command_angle) == 0);
}

TEST_CASE("requirement 108: Status follows the shaft", "[requirement-108][requirement-4]") {
  Rig rig(calm);
  send(rig, {{1, 1, 0.9F}});
  std::vector<float> positions;
  for (const can::Frame& one : only(rig.bench.run(2s), dronecan::ActuatorStatus::type.id)) {
    if ((one.data[one.size - 1] & 0x80U) != 0) {
      positions.push_back(
          dronecan::from_float16(static_cast<std::uint16_t>(one.data[3] | one.data[4] << 8)));
    }
  }
  REQUIRE(positions.size() == 20);
  CHECK(std::ranges::is_sorted(positions));
  CHECK(positions[0] < 0.89F);
  CHECK(std::abs(positions.back() - 0.9F) < 0.006F);
}

TEST_CASE("requirement 108: what the unused fields of Status hold is a setting",
          "[requirement-108][unproven]") {
  const auto frames = [](const char* fields) {
    Rig rig(with(fmt::format(R"("behaviour": {{"unused_fields": "{}"}})", fields)), 0ms);
    const auto sent = only(rig.bench.run(200ms), dronecan::ActuatorStatus::type.id);
    return Frames{testing::text(sent.at(0)).substr(13), testing::text(sent.at(1)).substr(9)};
  };
  CHECK(frames("unknown") == Frames{"010000FF7F80", "FF7F7F60"});
  CHECK(frames("zero") == Frames{"010000000080", "00000060"});
}

TEST_CASE("requirements 21, 22, 24: health is that of the present bits, failure first",
          "[requirement-21][requirement-22][requirement-24]") {
  Rig rig(calm);
  CHECK(health(rig) == 0);
  CHECK(value(rig, address::fault_notice) == fault::pwm_missing); // a notice only
  around(rig, [](World& world) { world.board_celsius = 80; });
  CHECK(health(rig) == 1);
  around(rig, [](World& world) { world.driver_stopped = true; });
  CHECK(health(rig) == 2);
  around(rig, [](World& world) { world.board_celsius = 25; });
  CHECK(health(rig) == 2);
  around(rig, [](World& world) { world.driver_stopped = false; });
  CHECK(health(rig) == 0);
}

TEST_CASE("requirement 22: notices may make health a warning", "[requirement-22][unproven]") {
  Rig rig(with(R"("behaviour": {"notices_warn": true})"));
  CHECK(health(rig) == 1);
  around(rig, [](World& world) { world.pulse_us = 1520; });
  CHECK(health(rig) == 0);
  around(rig, [](World& world) { world.driver_stopped = true; });
  CHECK(health(rig) == 2);
}

TEST_CASE("requirement 23: the mode is operational while it runs", "[requirement-23]") {
  Rig rig(calm);
  around(rig, [](World& world) { world.driver_stopped = true; });
  for (const can::Frame& one : only(rig.bench.run(3s), dronecan::NodeStatus::type.id)) {
    CHECK((one.data[4] & 0x3FU) == 0);
  }
}

TEST_CASE("requirement 163: up to 3 V there is no answer; with more it starts as at power-on",
          "[requirement-163][requirement-46][requirement-17]") {
  Rig rig(calm);
  CHECK(rig.write("0x38", 2700) == 2700);
  CHECK(rig.write("0x00", 2700) == 2700);
  rig.bench.run(3s);
  around(rig, [](World& world) { world.supply_decivolt = 31; });
  CHECK(rig.read("0x0C") == 31);
  CHECK((*rig.read("0x1A") & fault::voltage_low) != 0);
  around(rig, [](World& world) { world.supply_decivolt = 30; });
  CHECK_FALSE(rig.read("0x0C"));
  CHECK(rig.bench.run(10s).empty());
  CHECK(rig.servo.next_deadline() == never);
  around(rig, [](World& world) { world.supply_decivolt = 120; });
  CHECK(testing::uptimes(rig.bench.run(200ms)) ==
        std::vector<std::pair<std::uint32_t, unsigned>>{{0, 0}});
  CHECK(rig.read("0x38") == 1799); // it was not saved
  CHECK(std::abs(value(rig, address::current_angle) + 900) <= 5);
  CHECK(rig.told() == Frames{"restart 11"});
}

TEST_CASE("requirement 163: a servo that never had power is dead until it has",
          "[requirement-163]") {
  Rig rig(with(R"("ram": {"current_voltage": "3V"})"));
  CHECK(rig.bench.run(10s).empty());
  CHECK(rig.servo.next_deadline() == never);
  around(rig, [](World& world) { world.supply_decivolt = 120; });
  CHECK_FALSE(rig.bench.run(200ms).empty());
  CHECK(rig.read("0x0C") == 120);
}

TEST_CASE("faults: a servo that is dead after a restart stays dead with new power") {
  Rig rig(with(R"("faults": {"never_returns": true})"));
  around(rig, [](World& world) { world.supply_decivolt = 0; });
  around(rig, [](World& world) { world.supply_decivolt = 120; });
  CHECK(rig.bench.run(1min).empty());
}

TEST_CASE("requirement 65: power that goes while ROM is written leaves the defaults and a bit",
          "[requirement-65]") {
  Rig rig(calm);
  CHECK(rig.write("0x38", 900) == 900);
  CHECK(rig.opcode(dronecan::ExecuteOpcode::save) == "ok");
  rig.bench.run(20ms);
  around(rig, [](World& world) { world.supply_decivolt = 0; });
  CHECK(rig.bench.run(1s).empty());
  CHECK(rig.servo.rom_writes() == 0);
  around(rig, [](World& world) { world.supply_decivolt = 120; });
  rig.bench.run(200ms);
  CHECK(rig.servo.node_id() == dronecan::anonymous); // 0x46 is 0 as well
  CHECK(value(rig, address::angle_limit_cw) == 1799);
  CHECK(value(rig, address::soft_start) == 1);
  CHECK(value(rig, address::fault_warning) == fault::rom_unreadable);
  around(rig, [](World& world) { world.supply_decivolt = 0; });
  around(rig, [](World& world) { world.supply_decivolt = 120; });
  rig.bench.run(200ms);
  CHECK(value(rig, address::fault_warning) == fault::rom_unreadable); // until it is saved anew
  rig.allocate(125);
  CHECK(rig.opcode(dronecan::ExecuteOpcode::save) == "ok");
  rig.settle();
  CHECK(rig.servo.rom_writes() == 1);
  CHECK(value(rig, address::fault_warning) == 0);
}

TEST_CASE("power that goes before ROM is written leaves ROM as it was") {
  Rig rig(R"("model": "BLA21-12U-AB", "node_id": 11, "answer_delay": "5ms")");
  CHECK(rig.bench.ask({frame("1E0A8BFF#00000000000000C1")}).empty());
  around(rig, [](World& world) { world.supply_decivolt = 0; });
  around(rig, [](World& world) { world.supply_decivolt = 120; });
  rig.bench.run(1s);
  CHECK(rig.servo.rom_writes() == 0);
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));
  CHECK(value(rig, address::fault_warning) == 0);
  CHECK(rig.told() == Frames{"restart 11"});
}

TEST_CASE("requirement 167: why it restarted by itself stays until the next start",
          "[requirement-167]") {
  for (const auto& [cause, bit] : {std::pair{Servo::Upset::clock, fault::clock},
                                   std::pair{Servo::Upset::watchdog, fault::watchdog},
                                   std::pair{Servo::Upset::memory, fault::memory}}) {
    Rig rig(calm);
    rig.servo.upset(cause, rig.bench.now());
    CHECK_FALSE(rig.read("0x1B"));
    rig.settle();
    CHECK(rig.read("0x1B") == bit);
    rig.bench.run(10s);
    CHECK(rig.read("0x1B") == bit);
    rig.servo.upset(cause, rig.bench.now()); // again
    rig.settle();
    CHECK(rig.read("0x1B") == bit);
    CHECK(rig.restart_node() == "ok");
    rig.settle();
    CHECK(rig.read("0x1B") == 0);
    CHECK(rig.told() == Frames{"restart 11", "restart 11", "restart 11"});
  }
}

TEST_CASE("requirement 47: a restart runs the soft start again", "[requirement-47]") {
  for (const char* setting : {"on", "off"}) {
    Rig rig(fmt::format(R"("model": "BLA21-12U-AB", "node_id": 11,
        "rom": {{"timeout_action": "hold", "soft_start": "{}"}})",
                        setting));
    CHECK(rig.write("0x00", 900) == 900);
    rig.bench.run(2s);
    CHECK(rig.restart_node() == "ok");
    rig.bench.run(2s);
    const bool soft = setting == std::string("on");
    CHECK(std::abs(value(rig, address::current_angle) - (soft ? 0 : 900)) <= 5);
  }
}

TEST_CASE("requirements 54, 56: while ROM is written and after it all motion stops",
          "[requirement-54][requirement-56]") {
  Rig rig(calm);
  CHECK(rig.write("0x25", 1) == 1);
  CHECK(rig.write("0x01", 100) == 100);
  rig.bench.run(1s);
  CHECK(value(rig, address::current_speed) == 100);
  CHECK(rig.opcode(dronecan::ExecuteOpcode::save) == "ok");
  rig.bench.run(40ms);
  CHECK(value(rig, address::current_speed) == 0);
  rig.bench.run(1s);
  CHECK(rig.read("0x09") == 0); // the command was not saved
  CHECK(rig.read("0x25") == 1);
}

TEST_CASE("faults: a servo that stays after SAVE moves again when it is commanded") {
  Rig rig(with(R"("faults": {"stays": true})"));
  CHECK(rig.opcode(dronecan::ExecuteOpcode::save) == "ok");
  rig.bench.run(1s);
  CHECK(rig.write("0x00", 300) == 300);
  rig.bench.run(1s);
  CHECK(std::abs(value(rig, address::current_angle) - 300) <= 5);
}

TEST_CASE("requirement 61: after ERASE the commands are those of the defaults",
          "[requirement-61]") {
  Rig rig(calm);
  CHECK(rig.write("0x00", 450) == 450);
  rig.bench.run(900ms);
  CHECK(rig.opcode(dronecan::ExecuteOpcode::erase) == "ok");
  CHECK(rig.read("0x00") == 0);
}
