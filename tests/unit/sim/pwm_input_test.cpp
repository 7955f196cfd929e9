#include "blactl/bla/pwm_mapping.hpp"
#include "blactl/sim/servo/pwm_input.hpp"

#include "sim/servo/names.hpp"
#include "unit/sim/motion_rig.hpp"

#include <vector>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using namespace blactl::sim::address;
using testing::MotionRig;
using testing::servo_setup;

namespace {

struct Mapping {
  std::int64_t neutral, range, output, mode;
};

PulseReading pulse(std::optional<std::int64_t> width, const Mapping& mapping = {1520, 700, 700, 0},
                   bool end_points_move = true) {
  Memory registers(servo_setup(R"("model": "BLA21-12U-AB")"));
  registers.set(pwm_neutral, mapping.neutral);
  registers.set(pwm_range, mapping.range);
  registers.set(pwm_output_range, mapping.output);
  registers.set(pwm_mode, mapping.mode);
  return read_pulse(width, registers, end_points_move);
}

void give_pulse(MotionRig& rig, std::optional<std::int64_t> width) {
  rig.around([&](World& world) { world.pulse_us = width; });
}

} // namespace

TEST_CASE("requirements 150-153: the four examples of 4.30",
          "[requirement-150][requirement-151][requirement-152][requirement-153]") {
  const auto value = [](std::int64_t width, const Mapping& mapping, Address address) {
    const auto command = pulse(width, mapping).command;
    REQUIRE(command);
    CHECK(command->address == address);
    return command->value;
  };
  const Mapping first{1520, 700, 700, 0}, second{1520, 700, 1400, 0}, third{1000, 500, 700, 0},
      fourth{1520, 700, 150, 1};
  CHECK(value(820, first, command_angle) == -700);
  CHECK(value(1520, first, command_angle) == 0);
  CHECK(value(1521, first, command_angle) == 1);
  CHECK(value(2220, first, command_angle) == 700);
  CHECK(value(820, second, command_angle) == -1400);
  CHECK(value(2220, second, command_angle) == 1400);
  CHECK(value(500, third, command_angle) == -700);
  CHECK(value(1000, third, command_angle) == 0);
  CHECK(value(1500, third, command_angle) == 700);
  CHECK(value(820, fourth, command_speed) == -150);
  CHECK(value(1520, fourth, command_speed) == 0);
  CHECK(value(2220, fourth, command_speed) == 150);
}

TEST_CASE("requirement 158: no pulse, too short, too long: a bit, and no input",
          "[requirement-158]") {
  CHECK(pulse({}).notices == fault::pwm_missing);
  CHECK(pulse(819).notices == fault::pwm_too_short);
  CHECK(pulse(2221).notices == fault::pwm_too_long);
  CHECK(pulse(821).notices == 0);
  CHECK(pulse(2219).notices == 0);
  for (const std::optional<std::int64_t> width : {std::optional<std::int64_t>(), {819}, {2221}}) {
    CHECK_FALSE(pulse(width).command);
  }
}

TEST_CASE("requirement 158: the end points set the bit; whether they move the servo is a setting",
          "[requirement-158][unproven]") {
  const Mapping usual{1520, 700, 700, 0};
  for (const bool moves : {true, false}) {
    CHECK(pulse(820, usual, moves).notices == fault::pwm_too_short);
    CHECK(pulse(2220, usual, moves).notices == fault::pwm_too_long);
    CHECK(pulse(820, usual, moves).command.has_value() == moves);
    CHECK(pulse(2220, usual, moves).command.has_value() == moves);
  }
  for (const bool moves : {true, false}) {
    MotionRig rig(
        MotionRig::with(fmt::format(R"("behaviour": {{"pwm_end_points_move": {}}})", moves)));
    give_pulse(rig, 2220);
    rig.run(2s);
    CHECK(rig.stands_at(moves ? 700 : 0));
  }
}

TEST_CASE("requirement 154: PWM writes 0x00 or 0x01, then limits and reverse apply",
          "[requirement-154]") {
  MotionRig rig(MotionRig::cascade());
  give_pulse(rig, 2120);
  rig.run(2s);
  CHECK(rig.read(command_angle) == 600);
  CHECK(rig.read(command_speed) == bla::not_active);
  CHECK(rig.stands_at(600));
  rig.write(angle_limit_cw, 300);
  rig.run(2s);
  CHECK(rig.stands_at(300));
  rig.write(reverse, 1);
  rig.run(2s);
  CHECK(rig.stands_at(300));
  CHECK(rig.shaft_decideg() < -290);
  rig.write(pwm_output_range, 100);
  rig.write(pwm_mode, 1);
  rig.run(1s);
  CHECK(rig.read(command_speed) == 85); // 100 * 600 / 700
  CHECK(rig.read(command_angle) == bla::not_active);
  CHECK(rig.rpm() == 85);
  CHECK(rig.motion.shaft().speed < 0); // reversed
}

TEST_CASE("a speed by PWM beyond the range of 0x01 is the greatest there is") {
  MotionRig rig(MotionRig::cascade());
  rig.write(pwm_mode, 1);
  rig.write(pwm_output_range, 3600);
  give_pulse(rig, 2219);
  rig.run(1s);
  CHECK(rig.read(command_speed) == 300);
}

TEST_CASE("requirement 155: speed by PWM needs 0x25", "[requirement-155]") {
  MotionRig rig;
  rig.write(pwm_mode, 1);
  give_pulse(rig, 2000);
  rig.run(1s);
  CHECK(rig.rpm() == 0);
  CHECK(rig.read(command_speed) == 0);
  rig.write(speed_torque_control, 1);
  rig.run(1s);
  CHECK(rig.rpm() > 90);
}

TEST_CASE("requirements 156, 157: CAN goes first, PWM comes back after 0x27 without a command",
          "[requirement-156][requirement-157]") {
  MotionRig rig;
  give_pulse(rig, 1720);
  rig.run(2s);
  CHECK(rig.stands_at(200));
  CHECK(rig.write(command_angle, -300) == -300);
  rig.run(990ms);
  CHECK(rig.stands_at(-300));
  CHECK(rig.read(command_angle) == -300);
  rig.run(20ms);
  CHECK(rig.read(command_angle) == 200);
  rig.run(1s);
  CHECK(rig.stands_at(200));
}

TEST_CASE("requirement 157: at the start a pulse counts at once, or after 0x27",
          "[requirement-157][unproven]") {
  for (const bool waits : {false, true}) {
    MotionRig rig(
        MotionRig::with(fmt::format(R"("behaviour": {{"pwm_waits_after_start": {}}})", waits)));
    give_pulse(rig, 1720);
    rig.run(900ms);
    CHECK(rig.stands_at(waits ? 0 : 200));
    rig.run(900ms);
    CHECK(rig.stands_at(200));
  }
}

TEST_CASE("requirements 145, 158: pulses feed the timeout, their end does not",
          "[requirement-145][requirement-158]") {
  MotionRig rig(R"("model": "BLA21-12U-AB", "rom": {"soft_start": "off"})");
  give_pulse(rig, 1720);
  rig.run(60s);
  rig.around([](World& world) { world.load_percent = 20; });
  rig.run(1s);
  CHECK(rig.torque() != 0); // it holds
  give_pulse(rig, 300);     // too short: as if there were none
  rig.run(990ms);
  CHECK(rig.torque() != 0);
  rig.run(20ms);
  CHECK(rig.torque() == 0);
  give_pulse(rig, 1720);
  rig.around([](World& world) { world.load_percent = 0; });
  rig.run(2s);
  CHECK(rig.stands_at(200));
}

TEST_CASE("requirement 159: a model without PWM input does not know pulses", "[requirement-159]") {
  MotionRig rig(R"("model": "BLA21-12U-A0")");
  for (const std::optional<std::int64_t> width :
       {std::optional<std::int64_t>(), {100}, {1520}, {2000}, {9000}}) {
    give_pulse(rig, width);
    rig.run(1s);
    CHECK(rig.read(fault_notice) == 0);
    CHECK(rig.read(command_angle) == 0);
  }
  MotionRig pwm(MotionRig::calm);
  CHECK(pwm.noticed(fault::pwm_missing));
  CHECK(pwm.read(fault_summary) == 1 << 16);
}

TEST_CASE("a firmware without 0x34 to 0x37 sees no pulse") {
  MotionRig rig(R"("model": "BLA21-12U-AB", "firmware_version": 1010)");
  give_pulse(rig, 2000);
  rig.run(1s);
  CHECK(rig.read(command_angle) == 0);
}

TEST_CASE("turns of a speed command are forgotten when PWM takes over, looked at or not",
          "[requirement-124][requirement-157]") {
  const auto shaft_after = [](Duration look) {
    MotionRig rig(MotionRig::cascade());
    give_pulse(rig, 1720);
    rig.write(timeout_time, 4000);
    rig.write(command_speed, 100);
    for (Duration gone{}; gone < 8s; gone += look) {
      rig.run(look);
    }
    CHECK(rig.stands_at(200));
    return rig.motion.shaft();
  };
  const Shaft once = shaft_after(8s);
  CHECK(once.angle > 20'000 * angle_per_decideg);
  CHECK(shaft_after(10ms) == once);
}

namespace {

/// What the tool makes of the servo's registers.
bla::PwmMapping mapping_of(MotionRig& rig) {
  bla::Values values;
  for (const Address address : bla::pwm_registers()) {
    values.emplace(address, rig.read(address));
  }
  const auto mapping = bla::pwm_mapping(values);
  REQUIRE(mapping);
  return *mapping;
}

/// Pulses from below the shortest to above the longest: twenty.
std::vector<std::int64_t> widths_of(const bla::PwmMapping& mapping) {
  constexpr std::int64_t count = 20;
  const std::int64_t first = mapping.shortest_us() - 10;
  const std::int64_t length = mapping.longest_us() + 10 - first;
  std::vector<std::int64_t> widths;
  for (std::int64_t i = 0; i < count; ++i) {
    widths.push_back(first + length * i / (count - 1));
  }
  return widths;
}

} // namespace

TEST_CASE("the servo goes where the mapping says that a pulse sends it") {
  MotionRig rig(
      MotionRig::with(R"("ram": {"angle_limit_cw": "50deg", "angle_limit_ccw": "-60deg"})"));
  const bla::PwmMapping mapping = mapping_of(rig);
  std::size_t valid = 0;
  for (const std::int64_t width : widths_of(mapping)) {
    INFO(width);
    const std::int64_t before = rig.angle();
    give_pulse(rig, width);
    rig.run(5s);
    const auto limited = mapping.limited_command(width);
    CHECK(rig.stands_at(limited.value_or(before)));
    if (const auto command = mapping.command(width)) {
      CHECK(rig.read(command_angle) == *command);
      ++valid;
    }
  }
  CHECK(valid == 18);
}

TEST_CASE("the servo turns as fast as the mapping says that a pulse makes it") {
  MotionRig rig(R"("model": "BLA21-12U-AB", "rom": {"soft_start": "off", "timeout_action": "off",
      "speed_torque_control": "on", "pwm_mode": "speed", "pwm_output_range": "100rpm",
      "speed_limit_cw": "60rpm"})");
  const bla::PwmMapping mapping = mapping_of(rig);
  std::size_t valid = 0;
  for (const std::int64_t width : widths_of(mapping)) {
    INFO(width);
    give_pulse(rig, width);
    rig.run(5s);
    const std::int64_t limited = mapping.limited_command(width).value_or(0);
    constexpr std::int64_t slowest = 10; // 4.2: below, a servo may stand
    CHECK(rig.rpm() == (std::abs(limited) < slowest ? 0 : limited));
    if (const auto command = mapping.command(width)) {
      CHECK(rig.read(command_speed) == *command);
      ++valid;
    }
  }
  CHECK(valid == 18);
}
