// What the specification leaves open about the shaft: a setting each, and what is likelier.

#include "sim/servo/names.hpp"
#include "unit/sim/motion_rig.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using namespace blactl::sim::address;
using testing::MotionRig;

namespace {

constexpr std::int64_t on = 0, off = 1, brake = 2;

/// A calm one with a setting of "behaviour".
std::string behaving(const char* setting, const char* more = "") {
  return MotionRig::with(fmt::format(R"("behaviour": {{{}}} {})", setting, more));
}

void load(MotionRig& rig, std::int64_t percent) {
  rig.around([&](World& world) { world.load_percent = percent; });
}

} // namespace

TEST_CASE("requirement 93: a firmware without 0x25 knows no speed, unless the servo is set so",
          "[requirement-93][requirement-117][unproven]") {
  const auto rpm = [](const char* setting) {
    MotionRig rig(behaving(setting, R"(, "firmware_version": 1010)"));
    rig.write(speed_limit_cw, 40);
    rig.write(command_speed, 100);
    rig.run(1s);
    return rig.rpm();
  };
  CHECK(rpm("") == 0);
  CHECK(rpm(R"("speed_control_before_1100": true)") == 40); // and 0x3A counts
  // Of a firmware with 0x25 that one decides.
  MotionRig newer(behaving(R"("speed_control_before_1100": true)"));
  newer.write(command_speed, 100);
  newer.run(1s);
  CHECK(newer.rpm() == 0);
}

TEST_CASE("requirement 143: what a timeout cut may go on slowly with the next command",
          "[requirement-143][requirement-147][unproven]") {
  const auto fastest = [](const char* resumes) {
    MotionRig rig(fmt::format(R"("model": "BLA21-12U-AB", "ram": {{"current_angle": "-170deg"}},
        "rom": {{"timeout_time": "300ms"}}, "behaviour": {{"soft_start_resumes": {}}})",
                              resumes));
    rig.run(1s);
    CHECK(rig.torque() == 0);
    CHECK(rig.angle() < -800);
    rig.write(timeout_action, 0);
    rig.write(command_angle, 0);
    std::int64_t rpm = 0;
    for (int i = 0; i < 3000; ++i) {
      rig.run(1ms);
      rpm = std::max(rpm, rig.rpm());
    }
    CHECK(rig.stands_at(0));
    return rpm;
  };
  CHECK(fastest("false") > 60);
  CHECK(fastest("true") <= 31);
}

TEST_CASE("a soft start that goes on ends where the command leads, or with the one after it",
          "[requirement-143][unproven]") {
  constexpr const char* resumes = R"("model": "BLA21-12U-AB", "ram": {"current_angle": "-170deg"},
      "rom": {"timeout_time": "300ms"},
      "behaviour": {"soft_start_resumes": true, "soft_start_shows": true})";
  MotionRig rig(resumes);
  rig.run(1s);
  rig.write(timeout_action, 0);
  const std::int64_t there = rig.angle();
  rig.write(command_angle, there + 300);
  rig.run(50ms);
  CHECK(rig.read(speed_limit_cw) == 30);
  CHECK(rig.rpm() <= 31);
  rig.run(1s);
  CHECK(rig.stands_at(there + 300));
  CHECK(rig.read(speed_limit_cw) == 300);

  MotionRig other(resumes);
  other.run(1s);
  other.write(timeout_action, 0);
  other.write(command_angle, 0);
  CHECK(other.read(speed_limit_cw) == 30);
  other.write(command_angle, 0);
  CHECK(other.read(speed_limit_cw) == 300);

  MotionRig stopped(resumes); // protection ends it for good
  stopped.run(1s);
  stopped.around([](World& world) { world.board_celsius = 90; });
  stopped.around([](World& world) { world.board_celsius = 25; });
  stopped.write(command_angle, 0);
  CHECK(stopped.read(speed_limit_cw) == 300);
}

TEST_CASE("requirement 61: 0x10 while the output is off or braked: it holds, or goes to 0 deg",
          "[requirement-61][requirement-132][unproven]") {
  for (const std::int64_t output : {off, brake}) {
    const auto after = [&](const char* setting) {
      MotionRig rig(behaving(setting));
      rig.write(command_angle, 450);
      rig.run(1s);
      rig.write(torque_output, output);
      rig.motion.initialize(rig.now);
      CHECK(rig.read(torque_output) == on);
      rig.write(timeout_action, 0);
      rig.run(2s);
      return rig.angle();
    };
    CHECK(std::abs(after("") - 450) <= 5);
    CHECK(std::abs(after(R"("erase_holds": false)")) <= 5);
  }
}

TEST_CASE("requirement 131: a timeout to OFF leaves the brake, unless the servo is set so",
          "[requirement-131][requirement-145][unproven]") {
  const auto turned = [](const char* setting, std::int64_t output, std::int64_t action) {
    MotionRig rig(behaving(setting));
    rig.write(timeout_action, action);
    rig.write(torque_output, output);
    rig.run(2s);
    load(rig, 20);
    rig.run(1s);
    return rig.angle() != 0;
  };
  constexpr const char* lets_go = R"("timeout_beats_brake": true)";
  CHECK_FALSE(turned("", brake, off));
  CHECK(turned(lets_go, brake, off));
  CHECK_FALSE(turned(lets_go, brake, 0)); // hold
  CHECK_FALSE(turned(lets_go, brake, brake));
  CHECK(turned(lets_go, off, brake));
}

TEST_CASE("requirement 117: a speed outlives 0x25 = 0, unless the servo is set so",
          "[requirement-117][unproven]") {
  for (const bool keeps : {true, false}) {
    for (const Address command : {command_speed, command_torque}) {
      MotionRig rig(behaving(keeps ? "" : R"("keeps_disabled_command": false)"));
      rig.write(speed_torque_control, 1);
      rig.write(command, 60);
      rig.write(speed_torque_control, 0);
      CHECK(rig.read(command) == (keeps ? 60 : 0));
      rig.run(1s);
      CHECK(rig.rpm() == 0);
      rig.write(speed_torque_control, 1);
      rig.run(1s);
      CHECK((rig.rpm() > 0) == keeps);
    }
  }
  MotionRig angle(behaving(R"("keeps_disabled_command": false)"));
  angle.write(speed_torque_control, 1);
  angle.write(command_angle, 450);
  angle.write(speed_torque_control, 0);
  CHECK(angle.read(command_angle) == 450);
}

TEST_CASE("requirement 111: an angle beyond a limit outlives it, unless the servo is set so",
          "[requirement-111][unproven]") {
  for (const bool keeps : {true, false}) {
    MotionRig rig(behaving(keeps ? "" : R"("keeps_limited_angle": false)"));
    rig.write(angle_limit_cw, 450);
    CHECK(rig.write(command_angle, 900) == (keeps ? 900 : 450));
    rig.run(1s);
    CHECK(rig.stands_at(450));
    rig.write(angle_limit_cw, 1799);
    rig.run(1s);
    CHECK(rig.stands_at(keeps ? 900 : 450));
    rig.motion.command({command_angle, 1900}, rig.now);
    CHECK(rig.read(command_angle) == (keeps ? 1900 : 1799));
  }
}

TEST_CASE("requirement 157: PWM waits for every command, or for angle and speed only",
          "[requirement-156][requirement-157][unproven]") {
  const auto waits = [](const char* setting, Address command, std::int64_t value) {
    MotionRig rig(behaving(setting));
    rig.write(speed_torque_control, 1);
    rig.write(command, value);
    rig.around([](World& world) { world.pulse_us = 1720; });
    rig.run(10ms);
    return rig.read(command_angle) != 200;
  };
  constexpr const char* heading = R"("pwm_yields_to_all": false)";
  CHECK(waits("", torque_output, on));
  CHECK(waits("", command_torque, 20));
  CHECK_FALSE(waits(heading, torque_output, on));
  CHECK_FALSE(waits(heading, command_torque, 20));
  CHECK(waits(heading, command_angle, 300));
  CHECK(waits(heading, command_speed, 20));
}

TEST_CASE("requirement 138: after a start in place 0x00 tells the angle, or 0",
          "[requirement-138][unproven]") {
  for (const bool zero : {false, true}) {
    MotionRig rig(
        behaving(zero ? R"("start_angle": "zero")" : "", R"(, "ram": {"current_angle": "60deg"})"));
    CHECK(rig.read(command_angle) == (zero ? 0 : 600));
    rig.run(1s);
    CHECK(rig.stands_at(600)); // in place all the same
    rig.write(command_angle, 300);
    CHECK(rig.read(command_angle) == 300);
  }
  const auto told = [](auto command) {
    MotionRig rig(behaving(R"("start_angle": "zero")"));
    command(rig);
    rig.run(2ms);
    return rig.read(command_angle);
  };
  CHECK(told([](MotionRig& rig) { rig.motion.command({command_angle, 200}, rig.now); }) == 200);
  CHECK(told([](MotionRig& rig) { rig.around([](World& world) { world.pulse_us = 1720; }); }) ==
        200);
}

TEST_CASE("requirements 161, 165: stop and bit differ at a limit, unless the servo is set so",
          "[requirement-161][requirement-165][unproven]") {
  for (const bool inclusive : {false, true}) {
    for (const auto& [celsius, decivolt] :
         {std::pair{80, 120}, std::pair{-40, 120}, std::pair{25, 200}, std::pair{25, 40}}) {
      INFO(celsius << " degC " << decivolt);
      MotionRig rig(behaving(inclusive ? R"("inclusive_stops": true)" : ""));
      load(rig, 5);
      rig.around([=](World& world) {
        world.board_celsius = celsius;
        world.supply_decivolt = decivolt;
      });
      rig.run(300ms);
      CHECK(rig.read(fault_warning) != 0);
      CHECK((rig.torque() == 0) == inclusive);
    }
  }
}

TEST_CASE("requirement 170: bits that tell of the last restart hold no motor, unless set so",
          "[requirement-170][unproven]") {
  for (const bool stop : {false, true}) {
    for (const std::int64_t bit : {fault::clock, fault::watchdog, fault::memory}) {
      MotionRig rig(behaving(stop ? R"("restart_bits_stop": true)" : ""));
      rig.around([&](World& world) { world.failures = bit; });
      CHECK(rig.read(fault_failure) == bit);
      rig.write(command_angle, 450);
      rig.run(1s);
      CHECK(rig.stands_at(450) == !stop);
    }
  }
}
