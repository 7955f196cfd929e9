// What the specification leaves open about the shaft: a setting each, and what is likelier.

#include "blactl/sim/servo/array_entry.hpp"

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

/// One that starts softly from 150 deg away and holds without commands.
std::string starting(const char* setting) {
  return fmt::format(R"("model": "BLA21-12U-AB", "ram": {{"current_angle": "-150deg"}},
      "rom": {{"timeout_action": "hold"}}, "behaviour": {{{}}})",
                     setting);
}

std::int64_t fastest_rpm(MotionRig& rig) {
  std::int64_t rpm = 0;
  for (int i = 0; i < 6000; ++i) {
    rig.run(1ms);
    rpm = std::max(rpm, rig.rpm());
  }
  return rpm;
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

TEST_CASE("requirement 142: 0x20 = ON during a soft start: on at full speed, or on slowly",
          "[requirement-142][unproven]") {
  for (const bool ends : {true, false}) {
    MotionRig rig(starting(ends ? "" : R"("output_write_ends_soft_start": false)"));
    rig.run(300ms);
    rig.write(torque_output, on);
    const std::int64_t rpm = fastest_rpm(rig);
    CHECK(ends == (rpm > 60));
    CHECK((ends || rpm <= 31));
    CHECK(std::abs(rig.angle()) <= 15);
  }
  MotionRig other(starting(R"("output_write_ends_soft_start": false, "soft_start_shows": true)"));
  other.write(torque_output, on);
  CHECK(other.read(speed_limit_cw) == 30);
  other.write(torque_output, off); // without output there is nothing to go on
  CHECK(other.read(speed_limit_cw) == 300);
}

TEST_CASE("requirement 61: 0x10 leaves ROM, or puts it back to defaults as well",
          "[requirement-61][requirement-62][unproven]") {
  for (const bool clears : {false, true}) {
    MotionRig rig(fmt::format(R"("model": "BLA21-12U-AB", "rom": {{"soft_start": "off",
        "timeout_action": "hold", "angle_limit_cw": "45deg"}}, "servo_id": 7,
        "behaviour": {{"erase_clears_rom": {}}})",
                              clears));
    rig.motion.initialize(rig.now);
    CHECK(rig.read(angle_limit_cw) == 1799);
    CHECK(rig.registers.rom_value(angle_limit_cw) == (clears ? 1799 : 450));
    rig.restart();
    CHECK(rig.read(angle_limit_cw) == (clears ? 1799 : 450));
    CHECK(rig.read(servo_id) == (clears ? 0 : 7));
  }
}

TEST_CASE("requirement 98: a command to servo ID 0 is obeyed, or not",
          "[requirement-98][requirement-176][unproven]") {
  Behaviour behaviour;
  for (const bool obeys : {true, false}) {
    behaviour.obeys_servo_id_0 = obeys;
    CHECK(addresses({0, 1, 0}, 0, behaviour) == obeys);
    CHECK(addresses({255, 1, 0}, 0, behaviour));
    CHECK(addresses({7, 1, 0}, 7, behaviour));
    CHECK_FALSE(addresses({0, 1, 0}, 7, behaviour));
  }
}

TEST_CASE("requirement 49: 0x23, 0x27, 0x44, 0x45 act at once, or from the next start on",
          "[requirement-49][requirement-127][requirement-128][unproven]") {
  for (const bool waits : {false, true}) {
    MotionRig rig(behaving(waits ? R"("settings_wait_for_start": true)" : "",
                           R"(, "ram": {"current_angle": "60deg", "timeout_action": "off"})"));
    CHECK(rig.write(origin, 450) == 450);
    CHECK(rig.read(origin) == 450); // the register tells what was written
    CHECK(rig.angle() == (waits ? 600 : 150));
    rig.write(reverse, 1);
    CHECK(rig.angle() == (waits ? 600 : -150));
    rig.write(servo_id, 9);
    CHECK(rig.registers.in_effect(servo_id) == (waits ? 0 : 9));
    rig.write(timeout_time, 60'000);
    rig.write(command_angle, rig.angle());
    load(rig, 5);
    rig.run(1500ms);
    CHECK((rig.torque() == 0) == waits); // after the 1000 ms of before
    load(rig, 0);

    MotionRig saved(behaving(waits ? R"("settings_wait_for_start": true)" : "",
                             R"(, "ram": {"current_angle": "60deg"})"));
    saved.write(origin, 450);
    saved.write(reverse, 1);
    saved.registers.save();
    saved.restart();
    CHECK(saved.angle() == -150);
  }
}

TEST_CASE("requirement 170: bits of 0x1B that stay are cleared by a start, or by a loss of supply",
          "[requirement-167][requirement-170][unproven]") {
  for (const bool keeps : {false, true}) {
    MotionRig rig(behaving(keeps ? R"("restart_keeps_failures": true, "failures_latch": true)"
                                 : R"("failures_latch": true)"));
    rig.around([](World& world) {
      world.failures = fault::watchdog;
      world.driver_stopped = true;
    });
    rig.around([](World& world) { world.driver_stopped = false; });
    const std::int64_t both = fault::watchdog | fault::motor_driver;
    CHECK(rig.read(fault_failure) == both);
    rig.restart();
    CHECK(rig.read(fault_failure) == (keeps ? both : 0));
    rig.motion.stop(rig.now, true);
    rig.registers.restart();
    rig.motion.start(rig.now);
    CHECK(rig.read(fault_failure) == 0);
  }
}

TEST_CASE("requirement 106: ArrayCommand out of range is ignored, or clamped, whatever GetSet does",
          "[requirement-106][unproven]") {
  for (const char* get_set : {"refuse", "clamp"}) {
    for (const bool clamps : {false, true}) {
      MotionRig rig(behaving(fmt::format(R"("out_of_range": "{}", "array_out_of_range": "{}")",
                                         get_set, clamps ? "clamp" : "ignore")
                                 .c_str()));
      rig.write(speed_torque_control, 1);
      rig.motion.command({command_speed, 20}, rig.now);
      rig.motion.command({command_speed, 400}, rig.now);
      CHECK(rig.read(command_speed) == (clamps ? 300 : 20));
      rig.motion.command({command_torque, -150}, rig.now);
      CHECK(rig.read(command_torque) == (clamps ? -100 : bla::not_active));
      CHECK(rig.read(command_speed) == (clamps ? bla::not_active : 20));
    }
  }
}

TEST_CASE("requirement 128: 0x23 leaves where 0x44 has 0 deg, or turns that round as well",
          "[requirement-127][requirement-128][unproven]") {
  for (const bool turns : {false, true}) {
    MotionRig rig(behaving(turns ? R"("reverse_turns_origin": true)" : "",
                           R"(, "ram": {"current_angle": "60deg"})"));
    rig.write(origin, 450);
    CHECK(rig.angle() == 150);
    rig.write(reverse, 1);
    CHECK(rig.angle() == (turns ? -1050 : -150));
    rig.write(reverse, 0);
    CHECK(rig.angle() == 150);
    rig.write(reverse, 1);
    rig.write(command_angle, 0);
    rig.run(2s);
    CHECK(std::abs(rig.shaft_decideg() - (turns ? -450 : 450)) <= 5);
  }
}

TEST_CASE("requirement 180: a speed during a soft start is ignored without 0x25, or ends it",
          "[requirement-180][requirement-117][unproven]") {
  for (const bool keeps : {false, true}) {
    for (const Address command : {command_speed, command_torque}) {
      MotionRig rig(starting(keeps ? R"("soft_start_keeps_speed": true)" : ""));
      rig.run(300ms);
      rig.write(command, 20);
      CHECK((rig.read(command) == 20) == keeps);
      CHECK((rig.read(command_angle) == bla::not_active) == keeps);
      CHECK(fastest_rpm(rig) <= 31);
      CHECK((std::abs(rig.angle()) <= 15) == !keeps); // it went on to 0 deg
    }
  }
}

TEST_CASE("requirement 111: a command at its limit sets no bit of 0x19, or does",
          "[requirement-111][requirement-165][unproven]") {
  for (const bool notifies : {false, true}) {
    MotionRig rig(behaving(notifies ? R"("command_at_limit_notifies": true)" : ""));
    rig.write(torque_output, off); // the shaft stays at 0 deg
    rig.write(angle_limit_cw, 450);
    rig.write(angle_limit_ccw, -300);
    const auto bits = [&](std::int64_t angle) {
      rig.write(command_angle, angle);
      return rig.read(fault_notice) & (fault::angle_cw | fault::angle_ccw);
    };
    CHECK(bits(449) == 0);
    CHECK(bits(450) == (notifies ? fault::angle_cw : 0));
    CHECK(bits(451) == fault::angle_cw);
    CHECK(bits(-299) == 0);
    CHECK(bits(-300) == (notifies ? fault::angle_ccw : 0));
    CHECK(bits(-301) == fault::angle_ccw);
  }
}
