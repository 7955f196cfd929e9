// What goes wrong, how it shows and what it stops (4.7, 4.8, 4.12).

#include "sim/servo/names.hpp"
#include "sim/servo/protection.hpp"
#include "unit/sim/motion_rig.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using namespace blactl::sim::address;
using testing::MotionRig;
using testing::servo_setup;

namespace {

struct Cause {
  const char* name;
  void (*begin)(World&);
  void (*end)(World&);
};

constexpr std::array causes{
    Cause{"hot", [](World& world) { world.board_celsius = 81; },
          [](World& world) { world.board_celsius = 79; }},
    Cause{"cold", [](World& world) { world.board_celsius = -41; },
          [](World& world) { world.board_celsius = -39; }},
    Cause{"too much voltage", [](World& world) { world.supply_decivolt = 201; },
          [](World& world) { world.supply_decivolt = 120; }},
    Cause{"too little voltage", [](World& world) { world.supply_decivolt = 39; },
          [](World& world) { world.supply_decivolt = 120; }},
    Cause{"driver", [](World& world) { world.driver_stopped = true; },
          [](World& world) { world.driver_stopped = false; }},
    Cause{"motor", [](World& world) { world.rotation_abnormal = true; },
          [](World& world) { world.rotation_abnormal = false; }},
    Cause{"magnet", [](World& world) { world.magnet = Magnet::unreadable; },
          [](World& world) { world.magnet = Magnet::fine; }},
};

/// The faults of a servo that reads `value` in one register.
Faults with_reading(Address reading, std::int64_t value, bool inclusive = true) {
  const ServoSetup setup = servo_setup(R"("model": "BLA21-12U-AB")");
  Memory registers(setup);
  registers.set(reading, value);
  Behaviour behaviour;
  behaviour.inclusive_limits = inclusive;
  return present_faults(registers, world_of(setup), behaviour, false);
}

} // namespace

TEST_CASE("requirement 164: 0x0B counts degC, 0x0C 0.1 V", "[requirement-164]") {
  MotionRig rig;
  rig.around([](World& world) {
    world.board_celsius = -7;
    world.supply_decivolt = 60;
  });
  CHECK(rig.read(current_temperature) == -7);
  CHECK(rig.read(current_voltage) == 60);
}

TEST_CASE("requirement 165: every bit of 0x19 and 0x1A that compares, at its limit and inside",
          "[requirement-165]") {
  struct Row {
    Address reading;
    std::int64_t limit, inside;
    std::int64_t Faults::* level;
    std::int64_t bit;
  };

  for (const Row& row : {
           Row{current_angle, 1799, 1798, &Faults::notice, fault::angle_cw},
           Row{current_angle, -1800, -1799, &Faults::notice, fault::angle_ccw},
           Row{current_speed, 300, 299, &Faults::notice, fault::speed_cw},
           Row{current_speed, -300, -299, &Faults::notice, fault::speed_ccw},
           Row{current_torque, 100, 99, &Faults::notice, fault::torque_cw},
           Row{current_torque, -100, -99, &Faults::notice, fault::torque_ccw},
           Row{current_temperature, 80, 79, &Faults::warning, fault::temperature_high},
           Row{current_temperature, -40, -39, &Faults::warning, fault::temperature_low},
           Row{current_voltage, 200, 199, &Faults::warning, fault::voltage_high},
           Row{current_voltage, 40, 41, &Faults::warning, fault::voltage_low},
       }) {
    INFO(row.reading.name() << " " << row.limit);
    CHECK(with_reading(row.reading, row.limit).*row.level == row.bit);
    CHECK(with_reading(row.reading, row.inside).*row.level == 0);
    CHECK(with_reading(row.reading, row.limit).failure == 0);
  }
}

TEST_CASE("requirement 165: thresholds are inclusive, or not if the servo is set so",
          "[requirement-165][unproven]") {
  CHECK(with_reading(current_temperature, 80, false).warning == 0);
  CHECK(with_reading(current_temperature, 81, false).warning == fault::temperature_high);
  CHECK(with_reading(current_voltage, 40, false).warning == 0);
  CHECK(with_reading(current_voltage, 39, false).warning == fault::voltage_low);
  MotionRig idle(MotionRig::with(R"("ram": {"speed_limit_cw": 0})"));
  CHECK(idle.noticed(fault::speed_cw)); // errata B5: even at rest
  MotionRig strict(
      MotionRig::with(R"("ram": {"speed_limit_cw": 0}, "behaviour": {"inclusive_limits": false})"));
  CHECK_FALSE(strict.noticed(fault::speed_cw));
}

TEST_CASE("requirement 165: the bits of magnet, driver and motor", "[requirement-165]") {
  MotionRig rig;
  const auto bits = [&](void (*change)(World&)) {
    rig.around([](World& world) {
      world.magnet = Magnet::fine;
      world.driver_stopped = world.rotation_abnormal = false;
    });
    rig.around(change);
    return std::pair(rig.read(fault_warning), rig.read(fault_failure));
  };
  using Bits = std::pair<std::int64_t, std::int64_t>;
  CHECK(bits([](World&) {}) == Bits{0, 0});
  CHECK(bits([](World& world) { world.magnet = Magnet::weak; }) == Bits{1 << 4, 0});
  CHECK(bits([](World& world) { world.magnet = Magnet::strong; }) == Bits{1 << 5, 0});
  CHECK(bits([](World& world) { world.magnet = Magnet::unreadable; }) == Bits{0, 1 << 5});
  CHECK(bits([](World& world) { world.driver_stopped = true; }) == Bits{0, 1 << 0});
  CHECK(bits([](World& world) { world.rotation_abnormal = true; }) == Bits{0, 1 << 1});
}

TEST_CASE("with a weak or strong magnet operation is possible", "[requirement-165]") {
  for (const Magnet magnet : {Magnet::weak, Magnet::strong}) {
    MotionRig rig;
    rig.around([&](World& world) { world.magnet = magnet; });
    rig.write(command_angle, 450);
    rig.run(1s);
    CHECK(rig.stands_at(450));
  }
}

TEST_CASE("requirement 166: 0x18 tells level and group of every bit", "[requirement-166]") {
  for (int bit = 0; bit < 32; ++bit) {
    if (bit >= 20 && bit <= 22) {
      continue; // they follow the pulses
    }
    for (int level = 0; level < 3; ++level) {
      MotionRig rig(R"("model": "BLA21-12U-A0")");
      rig.around([&](World& world) {
        const std::array levels{&world.notices, &world.warnings, &world.failures};
        *levels.at(static_cast<std::size_t>(level)) = std::int64_t{1} << bit;
      });
      CHECK(rig.read(fault_summary) == std::int64_t{1} << (bit / 8 * 8 + level));
    }
  }
}

TEST_CASE(
    "requirements 161, 162, 170: out of range or failed it lets go; after that it holds where "
    "it is",
    "[requirement-161][requirement-162][requirement-170]") {
  for (const Cause& cause : causes) {
    INFO(cause.name);
    MotionRig rig;
    rig.write(command_angle, 450);
    rig.run(1s);
    rig.around(cause.begin);
    rig.around([](World& world) { world.load_percent = -20; });
    rig.run(300ms);
    CHECK(rig.torque() == 0);
    CHECK(rig.angle() < 300); // the load turns it
    CHECK(rig.read(command_angle) == 450);
    rig.around([](World& world) { world.load_percent = 0; });
    rig.run(100ms);
    const std::int64_t there = rig.angle();
    rig.around(cause.end);
    CHECK(rig.read(command_angle) == there);
    rig.run(1s);
    CHECK(rig.angle() == there);
    rig.around([](World& world) { world.load_percent = -20; });
    rig.run(1s);
    CHECK(rig.torque() != 0); // it holds again
    rig.write(command_angle, 450);
    rig.around([](World& world) { world.load_percent = 0; });
    rig.run(1s);
    CHECK(rig.stands_at(450));
  }
}

TEST_CASE("requirement 162: after a speed or torque command it brakes with 0",
          "[requirement-162]") {
  for (const Address command : {command_speed, command_torque}) {
    for (const Cause& cause : causes) {
      INFO(cause.name << " " << command.name());
      MotionRig rig(MotionRig::cascade());
      rig.write(command, 60);
      rig.run(1s);
      rig.around(cause.begin);
      rig.run(1s);
      CHECK(rig.rpm() == 0);
      CHECK(rig.read(command) == 60);
      rig.around(cause.end);
      CHECK(rig.read(command) == 0);
      CHECK(rig.read(command_angle) == bla::not_active);
      rig.run(1s);
      CHECK(rig.rpm() == 0);
    }
  }
}

TEST_CASE("requirement 161: a limit that is moved inside the reading stops as well",
          "[requirement-161]") {
  MotionRig rig;
  rig.write(command_angle, 450);
  rig.run(1s);
  rig.around([](World& world) { world.supply_decivolt = 121; });
  rig.write(voltage_limit_high, 120);
  rig.around([](World& world) { world.load_percent = 20; });
  rig.run(100ms);
  CHECK(rig.torque() == 0);
  rig.write(voltage_limit_high, 121);
  rig.run(100ms);
  CHECK(rig.torque() != 0);
}

TEST_CASE("on return a command beyond a limit is given up, and its bit with it",
          "[requirement-162][requirement-165]") {
  MotionRig rig;
  rig.around([](World& world) { world.board_celsius = 85; });
  rig.write(command_angle, 2000);
  CHECK(rig.noticed(fault::angle_cw));
  rig.around([](World& world) { world.board_celsius = 25; });
  CHECK(rig.registers.value(fault_notice) == fault::pwm_missing);
}

TEST_CASE("requirement 136: 0x20 cannot override protection", "[requirement-136]") {
  MotionRig rig;
  rig.write(command_angle, 450);
  rig.run(1s);
  rig.around([](World& world) { world.board_celsius = 85; });
  rig.write(torque_output, 1);
  rig.write(torque_output, 0);
  rig.write(command_angle, 0);
  rig.run(1s);
  CHECK(rig.stands_at(450));
  CHECK(rig.torque() == 0);
  rig.around([](World& world) { world.board_celsius = 25; });
  CHECK(std::abs(rig.read(command_angle) - 450) <= 5);
}

TEST_CASE("requirement 167: a bit goes with its cause", "[requirement-167]") {
  for (const Cause& cause : causes) {
    INFO(cause.name);
    MotionRig rig(R"("model": "BLA21-12U-A0")");
    CHECK(rig.read(fault_summary) == 0);
    rig.around(cause.begin);
    rig.run(1s);
    CHECK(rig.read(fault_summary) != 0);
    rig.around(cause.end);
    CHECK(rig.read(fault_summary) == 0);
  }
}

TEST_CASE("requirement 167: failures of the hardware can stay until the next start",
          "[requirement-167][unproven]") {
  MotionRig rig(MotionRig::with(R"("behaviour": {"failures_latch": true})"));
  rig.around([](World& world) { world.driver_stopped = true; });
  rig.around([](World& world) { world.driver_stopped = false; });
  rig.run(1s);
  CHECK(rig.read(fault_failure) == fault::motor_driver);
  rig.write(command_angle, 450);
  rig.run(1s);
  CHECK(rig.angle() == 0); // and the motor is off
  rig.restart();
  CHECK(rig.read(fault_failure) == 0);
  rig.write(command_angle, 450);
  rig.run(1s);
  CHECK(rig.stands_at(450));
}

TEST_CASE("bits that a scenario sets are set, and follow a restart only if they tell no restart",
          "[requirement-167]") {
  MotionRig rig(R"("model": "BLA21-12U-AB",
      "ram": {"fault_notice": 256, "fault_warning": 32784, "fault_failure": 2817})");
  CHECK(rig.read(fault_notice) == (256 | fault::pwm_missing));
  CHECK(rig.read(fault_warning) == (1 << 15 | 1 << 4));
  CHECK(rig.read(fault_failure) == (1 << 0 | 1 << 8 | 1 << 9 | 1 << 11));
  rig.restart();
  CHECK(rig.read(fault_warning) == 1 << 4);
  CHECK(rig.read(fault_failure) == 1);
}

TEST_CASE("a scenario says by 0x19 what is at the PWM input") {
  const auto notices = [](std::int64_t bits) {
    MotionRig rig(fmt::format(R"("model": "BLA21-12U-AB", "ram": {{"fault_notice": {}}})", bits));
    return rig.read(fault_notice);
  };
  CHECK(notices(0) == fault::pwm_missing);
  CHECK(notices(fault::pwm_missing) == fault::pwm_missing);
  CHECK(notices(fault::pwm_too_short) == fault::pwm_too_short);
  CHECK(notices(fault::pwm_too_long) == fault::pwm_too_long);
  MotionRig without(R"("model": "BLA21-12U-A0", "ram": {"fault_notice": 2097152})");
  CHECK(without.read(fault_notice) == 0);
}
