// 0x20, soft start and communication timeout (4.13, 4.14, 4.19, 4.31).

#include "blactl/sim/servo/motion.hpp"

#include "sim/servo/names.hpp"
#include "unit/sim/motion_rig.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using namespace blactl::sim::address;
using testing::MotionRig;

namespace {

constexpr std::int64_t on = 0, off = 1, brake = 2;

void hand(MotionRig& rig, std::optional<std::int64_t> angle) {
  rig.around([&](World& world) { world.hand_decideg = angle; });
}

void load(MotionRig& rig, std::int64_t percent) {
  rig.around([&](World& world) { world.load_percent = percent; });
}

/// By hand to an angle, which then is let go.
void turn_by_hand(MotionRig& rig, std::int64_t angle) {
  hand(rig, angle);
  rig.run(1s);
  hand(rig, std::nullopt);
}

constexpr const char* usual = R"("model": "BLA21-12U-AB")";

/// Just powered on at an angle, with the soft start of the factory.
std::string at(const char* angle, const char* rom = R"({"timeout_action": "hold"})") {
  return fmt::format(R"({}, "ram": {{"current_angle": "{}"}}, "rom": {})", usual, angle, rom);
}

} // namespace

TEST_CASE("requirement 131: OFF and brake do nothing for a command, brake holds a little",
          "[requirement-130][requirement-131]") {
  for (const std::int64_t output : {off, brake}) {
    MotionRig rig;
    CHECK(rig.write(torque_output, output) == output);
    rig.write(command_angle, 450);
    rig.run(1s);
    CHECK(rig.angle() == 0);
    CHECK(rig.torque() == 0);
    load(rig, 20);
    rig.run(1s);
    CHECK((rig.angle() > 100) == (output == off));
    load(rig, 60);
    rig.run(1s);
    CHECK(rig.angle() > 100);
  }
}

TEST_CASE("requirement 132: example 1, ON holds the present angle", "[requirement-132]") {
  for (const std::int64_t output : {off, brake}) {
    MotionRig rig;
    rig.write(command_angle, 450);
    rig.run(60ms);
    rig.write(torque_output, output);
    rig.run(1s);
    const std::int64_t there = rig.angle();
    CHECK(there > 20);
    CHECK(there < 400);
    rig.write(torque_output, on);
    rig.run(1s);
    CHECK(rig.angle() == there);
    CHECK(rig.read(command_angle) == there);
  }
}

TEST_CASE("requirements 132, 133: example 2, turned by hand meanwhile",
          "[requirement-132][requirement-133]") {
  MotionRig rig;
  rig.write(command_angle, 450);
  rig.run(1s);
  rig.write(torque_output, off);
  turn_by_hand(rig, 0);
  rig.run(1s);
  CHECK(rig.angle() == 0);
  rig.write(torque_output, on);
  load(rig, 10);
  rig.run(1s);
  CHECK(rig.rpm() == 0);
  CHECK(rig.torque() != 0); // it does hold
  CHECK(std::abs(rig.angle()) < 20);
}

TEST_CASE("requirements 132, 134: example 3, a speed command while it is off",
          "[requirement-132][requirement-134]") {
  for (const Address command : {command_speed, command_torque}) {
    MotionRig rig(MotionRig::cascade());
    rig.write(command_angle, 450);
    rig.run(1s);
    rig.write(torque_output, off);
    rig.write(command, -50);
    rig.run(1s);
    CHECK(rig.rpm() == 0);
    rig.write(torque_output, on);
    CHECK(rig.read(command) == 0);
    load(rig, 25);
    rig.run(1s);
    CHECK(rig.rpm() == 0); // braked
  }
}

TEST_CASE("requirement 132: ON while it is on discards nothing", "[requirement-132]") {
  MotionRig rig;
  rig.write(command_angle, 450);
  rig.write(torque_output, on);
  CHECK(rig.read(command_angle) == 450);
  rig.run(1s);
  CHECK(rig.stands_at(450));
}

TEST_CASE("requirement 135: 0x20 in ROM is how it starts", "[requirement-135]") {
  MotionRig rig(at("90deg", R"({"torque_output": "off"})"));
  rig.run(500ms);
  CHECK(rig.angle() == 900); // neither torque nor soft start
  rig.write(torque_output, on);
  rig.run(500ms);
  CHECK(rig.angle() == 900);
}

TEST_CASE("requirement 137: outside of its limit it stays until the next command",
          "[requirement-137]") {
  MotionRig rig;
  rig.write(angle_limit_cw, 900);
  rig.write(torque_output, off);
  turn_by_hand(rig, 1200);
  rig.run(1s);
  CHECK(rig.stands_at(1200));
  rig.write(torque_output, on);
  rig.run(1s);
  CHECK(rig.stands_at(1200));
  CHECK(rig.noticed(fault::angle_cw));
  rig.write(command_angle, 1200);
  rig.run(1s);
  CHECK(rig.stands_at(900));
}

TEST_CASE("requirement 138: soft start moves to 0 deg, as 0x44 has it; without it the servo stays",
          "[requirement-138]") {
  MotionRig soft(at("60deg"));
  soft.run(2s);
  CHECK(soft.stands_at(0));
  MotionRig shifted(at("60deg", R"({"timeout_action": "hold", "origin": "-30deg"})"));
  shifted.run(2s);
  CHECK(shifted.stands_at(0));
  CHECK(std::abs(shifted.shaft_decideg() + 300) <= 5);
  MotionRig in_place(at("60deg", R"({"timeout_action": "hold", "soft_start": "off"})"));
  in_place.run(2s);
  CHECK(in_place.angle() == 600);
  load(in_place, 10);
  in_place.run(1s);
  CHECK(in_place.torque() != 0); // the torque is on
}

TEST_CASE("requirement 139: only the first motion is soft", "[requirement-139]") {
  MotionRig rig(at("20deg"));
  rig.run(2s);
  CHECK(rig.stands_at(0));
  rig.write(command_angle, 1700);
  rig.run(100ms);
  CHECK(rig.rpm() > 100);
}

TEST_CASE("requirement 140: 30 rpm and 30 % while it lasts, and 0x25 as if it were on",
          "[requirement-140]") {
  MotionRig rig(at("-150deg"));
  std::int64_t rpm = 0;
  std::int64_t torque = 0;
  for (int i = 0; i < 700; ++i) {
    rig.run(1ms);
    rpm = std::max(rpm, rig.rpm());
    torque = std::max(torque, rig.torque());
  }
  CHECK(rpm <= 31);
  CHECK(rpm >= 29);
  CHECK(torque <= 30);
  CHECK(rig.read(speed_torque_control) == 0); // the registers do not tell
  CHECK(rig.read(speed_limit_cw) == 300);
  CHECK(rig.read(torque_limit_ccw) == -100);
}

TEST_CASE("requirement 180: while it lasts the bits of 0x19 know its limits, and a speed may count",
          "[requirement-180][requirement-142]") {
  for (const Address command : {command_speed, command_torque}) {
    MotionRig rig(at("-150deg") + R"(, "behaviour": {"soft_start_keeps_speed": true})");
    CHECK(rig.read(speed_torque_control) == 0);
    rig.run(300ms);
    CHECK(rig.rpm() >= 29);
    CHECK(rig.noticed(fault::speed_cw)); // 30 rpm, while 0x3A reads 300
    CHECK(rig.write(command, 20) == 20);
    CHECK(rig.read(command_angle) == bla::not_active);
    CHECK_FALSE(rig.noticed(fault::speed_cw)); // by that it is over
    rig.run(1s);
    CHECK(rig.rpm() == 0); // 0x25 is what it was
    CHECK(rig.write(command, 30) == 20);
  }
  MotionRig pushed(at("-150deg"));
  load(pushed, -35);
  pushed.run(1s);
  CHECK(pushed.torque() == 30);
  CHECK(pushed.noticed(fault::torque_cw));
}

TEST_CASE("requirement 140: a load of more than 30 % stops the soft start, a command does not mind",
          "[requirement-140]") {
  MotionRig rig(at("-150deg"));
  load(rig, -35);
  rig.run(1s);
  CHECK(rig.angle() < -1490);
  rig.write(command_angle, 0);
  rig.run(2s);
  CHECK(rig.angle() > -60);
}

TEST_CASE("requirement 144: reads can tell the limits of the soft start, if the servo is set so",
          "[requirement-144][unproven]") {
  for (const bool shows : {false, true}) {
    MotionRig rig(at("150deg") +
                  fmt::format(R"(, "behaviour": {{"soft_start_shows": {}}})", shows));
    const auto shown = [&] {
      return std::array{rig.read(speed_torque_control), rig.read(speed_limit_cw),
                        rig.read(speed_limit_ccw), rig.read(torque_limit_cw),
                        rig.read(torque_limit_ccw)};
    };
    using Shown = std::array<std::int64_t, 5>;
    CHECK(shown() == (shows ? Shown{1, 30, -30, 30, -30} : Shown{0, 300, -300, 100, -100}));
    CHECK(rig.read(angle_limit_cw) == 1799);
    rig.run(2s);
    CHECK(shown() == Shown{0, 300, -300, 100, -100});
  }
}

TEST_CASE("requirement 141: it ends within about 1 deg of 0", "[requirement-141][unproven]") {
  // The end shows in the limits that reads tell.
  MotionRig rig(at("10deg") + R"(, "behaviour": {"soft_start_shows": true})");
  while (rig.read(speed_limit_cw) == 30) {
    rig.run(1ms);
  }
  CHECK(rig.angle() <= 10);
  CHECK(rig.angle() >= 5);
}

TEST_CASE("requirement 142: it ends on every command and on a pulse", "[requirement-142]") {
  const auto ends = [](auto act) {
    MotionRig rig(at("150deg") + R"(, "behaviour": {"soft_start_shows": true})");
    rig.run(100ms);
    CHECK(rig.read(speed_limit_cw) == 30);
    act(rig);
    rig.run(2ms);
    return rig.read(speed_limit_cw) != 30;
  };
  CHECK(ends([](MotionRig& rig) { rig.write(command_angle, 100); }));
  CHECK(ends([](MotionRig& rig) { rig.write(torque_output, on); }));
  CHECK(ends([](MotionRig& rig) { rig.write(torque_output, off); }));
  CHECK(ends([](MotionRig& rig) {
    rig.write(speed_torque_control, 1);
    rig.write(command_speed, 20);
  }));
  CHECK(ends([](MotionRig& rig) {
    rig.write(speed_torque_control, 1);
    rig.write(command_torque, 20);
  }));
  CHECK(ends([](MotionRig& rig) { rig.around([](World& world) { world.pulse_us = 1500; }); }));
  CHECK_FALSE(ends([](MotionRig& rig) { rig.write(command_speed, 20); })); // 0x25 is off
  CHECK_FALSE(ends([](MotionRig& rig) { rig.write(angle_limit_cw, 900); }));
  CHECK_FALSE(ends([](MotionRig& rig) { rig.around([](World& world) { world.pulse_us = 100; }); }));
}

TEST_CASE("requirement 143: it ends with a timeout to OFF or brake, and with protection",
          "[requirement-143]") {
  for (const char* action : {"off", "brake"}) {
    const std::string rom =
        fmt::format(R"({{"timeout_action": "{}", "timeout_time": "500ms"}})", action);
    MotionRig rig(at("170deg", rom.c_str()) + R"(, "behaviour": {"soft_start_shows": true})");
    rig.run(520ms);
    const std::int64_t there = rig.angle();
    CHECK(there > 700);
    CHECK(rig.read(speed_limit_cw) == 300);
    rig.run(2s);
    CHECK(std::abs(rig.angle() - there) < 20);
  }
  MotionRig rig(at("170deg"));
  rig.run(300ms);
  rig.around([](World& world) { world.board_celsius = 90; });
  rig.run(300ms);
  rig.around([](World& world) { world.board_celsius = 25; });
  const std::int64_t there = rig.angle();
  rig.run(2s);
  CHECK(std::abs(rig.angle() - there) <= 3);
}

TEST_CASE("a soft start after a stop by protection that is over by then", "[requirement-138]") {
  MotionRig rig(at("60deg"));
  rig.around([](World& world) { world.board_celsius = 90; });
  rig.run(500ms);
  CHECK(rig.angle() == 600);
  rig.motion.stop(rig.now);
  rig.around([](World& world) { world.board_celsius = 25; });
  rig.registers.restart();
  rig.motion.start(rig.now);
  rig.run(2s);
  CHECK(rig.stands_at(0));
}

TEST_CASE("requirement 143: the shortest stop ends the soft start", "[requirement-143]") {
  MotionRig rig(at("170deg") + R"(, "behaviour": {"soft_start_shows": true})");
  rig.run(300ms);
  rig.around([](World& world) { world.board_celsius = 90; });
  rig.around([](World& world) { world.board_celsius = 25; });
  CHECK(rig.read(speed_limit_cw) == 300);
}

TEST_CASE(
    "requirements 145, 148: after 0x27 without a command it acts by 0x26; 1 s and OFF as default",
    "[requirement-145][requirement-148]") {
  const auto held_after = [](const char* action, Duration duration) {
    MotionRig rig(fmt::format(R"({}, "rom": {{"soft_start": "off"{}}})", usual, action));
    rig.write(command_angle, 450);
    load(rig, 20);
    rig.run(duration);
    return std::pair(rig.torque() != 0, std::abs(rig.angle() - 450) < 60);
  };
  CHECK(held_after("", 999ms) == std::pair(true, true));
  CHECK(held_after("", 1000ms).first == false);         // 0x27 itself is enough
  CHECK(held_after("", 3s) == std::pair(false, false)); // the load turns it
  CHECK(held_after(R"(, "timeout_action": "hold")", 3s) == std::pair(true, true));
  CHECK(held_after(R"(, "timeout_action": "brake")", 3s) == std::pair(false, true));
  CHECK(held_after(R"(, "timeout_time": "2500ms")", 2499ms).first == true);
  CHECK(held_after(R"(, "timeout_time": "2500ms")", 2500ms).first == false);
}

TEST_CASE("requirement 145: every command feeds the timeout", "[requirement-145]") {
  for (const auto& [command, value] :
       {std::pair{command_angle, 100}, std::pair{command_speed, 20}, std::pair{command_torque, 20},
        std::pair{torque_output, 0}}) {
    MotionRig rig(
        fmt::format(R"({}, "rom": {{"soft_start": "off", "speed_torque_control": "on"}})", usual));
    load(rig, 20);
    for (int i = 0; i < 5; ++i) {
      rig.write(command, value);
      rig.run(900ms);
      CHECK(rig.torque() != 0);
    }
    rig.run(200ms);
    CHECK(rig.torque() == 0);
  }
}

TEST_CASE("requirement 146: reads and other registers do not feed it, unless the servo is set so",
          "[requirement-146][unproven]") {
  for (const bool feeds : {false, true}) {
    for (const bool reads : {false, true}) {
      MotionRig rig(fmt::format(R"({}, "rom": {{"soft_start": "off"}},
          "behaviour": {{"get_set_feeds_timeout": {}}})",
                                usual, feeds));
      load(rig, 20);
      rig.write(command_angle, 100);
      for (int i = 0; i < 20; ++i) {
        rig.run(100ms);
        if (reads) {
          (void)rig.read(angle_limit_cw);
        } else {
          rig.write(angle_limit_cw, 1000 + i);
        }
      }
      CHECK((rig.registers.value(current_torque) != 0) == feeds);
    }
  }
}

TEST_CASE("requirement 146: ArrayCommand feeds it, unless the servo is set otherwise",
          "[requirement-146][unproven]") {
  for (const bool feeds : {true, false}) {
    MotionRig rig(fmt::format(R"({}, "rom": {{"soft_start": "off"}},
        "behaviour": {{"array_command_feeds_timeout": {}}})",
                              usual, feeds));
    load(rig, 20);
    for (int i = 0; i < 20; ++i) {
      rig.motion.command({command_angle, 100}, rig.now);
      rig.run(100ms);
    }
    CHECK((rig.torque() != 0) == feeds);
  }
}

TEST_CASE("requirement 147: the next command restores what was before the timeout",
          "[requirement-147]") {
  MotionRig rig(fmt::format(R"({}, "rom": {{"soft_start": "off"}})", usual));
  rig.write(command_angle, 450);
  rig.run(2s);
  turn_by_hand(rig, 0);
  rig.run(1s);
  CHECK(rig.stands_at(0));
  CHECK(rig.read(command_angle) == 450);
  rig.write(torque_output, on);
  rig.run(1s);
  CHECK(rig.stands_at(450));
}

TEST_CASE("requirement 61: 0x10 makes the commands jump to their defaults", "[requirement-61]") {
  MotionRig rig;
  rig.write(command_angle, 450);
  rig.run(900ms);
  CHECK(rig.stands_at(450));
  rig.motion.initialize(rig.now);
  CHECK(rig.read(command_angle) == 0);
  rig.write(torque_output, on); // the timeout has its default too
  rig.run(900ms);
  CHECK(rig.stands_at(0));
}
