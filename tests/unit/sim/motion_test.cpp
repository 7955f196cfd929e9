// Commands and what the shaft makes of them (4.1-4.6, 4.16-4.24, 4.31-4.33, 4.36).

#include "blactl/sim/node/random.hpp"
#include "blactl/sim/servo/motion.hpp"

#include "sim/servo/names.hpp"
#include "unit/sim/motion_rig.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using namespace blactl::sim::address;
using testing::MotionRig;

namespace {

/// The greatest of `value` while time passes, looked at every millisecond.
template <class Value> std::int64_t greatest(MotionRig& rig, Duration duration, Value value) {
  std::int64_t most = 0;
  for (Duration gone{}; gone < duration; gone += 1ms) {
    rig.run(1ms);
    most = std::max<std::int64_t>(most, std::abs(value()));
  }
  return most;
}

std::int64_t greatest_rpm(MotionRig& rig, Duration duration) {
  return greatest(rig, duration, [&] { return rig.rpm(); });
}

} // namespace

TEST_CASE("requirement 110: 0x00 moves to the angle, CW positive", "[requirement-110]") {
  for (const std::int64_t angle : {450, -450, 1790, -1790}) {
    MotionRig rig;
    CHECK(rig.write(command_angle, angle) == angle);
    CHECK(rig.angle() == 0);
    rig.run(2s);
    CHECK(rig.stands_at(angle));
    CHECK(std::abs(rig.shaft_decideg() - angle) <= 5);
  }
}

TEST_CASE(
    "all ten models come to the angle with the defaults of the factory, with and without 0x25",
    "[requirement-110]") {
  for (const bla::Profile& profile : testing::profiles().all()) {
    for (const char* control : {"on", "off"}) {
      INFO(profile.model << " " << control);
      MotionRig rig(fmt::format(R"("model": "{}", "ram": {{"speed_torque_control": "{}"}},
          "rom": {{"soft_start": "off", "timeout_action": "hold"}})",
                                profile.model, control));
      for (const std::int64_t angle : {900, -900, -880, 0}) {
        rig.write(command_angle, angle);
        rig.run(2s);
        INFO(rig.angle() << " " << rig.rpm());
        CHECK(rig.stands_at(angle));
      }
    }
  }
}

TEST_CASE("requirement 111: beyond a limit it moves to the limit, holds and says so",
          "[requirement-111]") {
  MotionRig rig;
  rig.write(angle_limit_cw, 900);
  rig.write(angle_limit_ccw, -300);
  rig.write(command_angle, 890);
  rig.run(2s);
  CHECK_FALSE(rig.noticed(fault::angle_cw));
  rig.write(command_angle, 1000);
  rig.run(2s);
  CHECK(rig.stands_at(900));
  CHECK(rig.noticed(fault::angle_cw));
  CHECK(rig.read(command_angle) == 1000);
  rig.write(command_angle, -1000);
  rig.run(2s);
  CHECK(rig.stands_at(-300));
  CHECK(rig.noticed(fault::angle_ccw));
  CHECK_FALSE(rig.noticed(fault::angle_cw));
}

TEST_CASE("requirements 112, 113: multi-turn as long as there is power; then the other way round",
          "[requirement-112][requirement-113][requirement-46]") {
  for (const bool power_cycle : {false, true}) {
    MotionRig rig;
    rig.write(angle_limit_cw, 2700);
    rig.write(command_angle, 2700);
    rig.run(3s);
    CHECK(rig.stands_at(2700));
    if (power_cycle) {
      rig.restart();
    }
    CHECK(rig.stands_at(power_cycle ? -900 : 2700));
    rig.write(command_angle, 0);
    rig.run(100ms);
    CHECK((rig.rpm() > 0) == power_cycle); // CW after the power cycle, else CCW
    rig.run(3s);
    CHECK(rig.stands_at(0));
    CHECK(std::abs(rig.shaft_decideg() - (power_cycle ? 3600 : 0)) <= 5);
  }
}

TEST_CASE("requirement 114: the command that rules silences the others", "[requirement-114]") {
  MotionRig rig(MotionRig::cascade());
  rig.write(command_angle, 300);
  rig.write(command_speed, 60);
  CHECK(rig.read(command_angle) == bla::not_active);
  CHECK(rig.read(command_torque) == bla::not_active);
  rig.run(1s);
  CHECK(rig.rpm() == 60);
  rig.write(command_torque, 30);
  CHECK(rig.read(command_speed) == bla::not_active);
  rig.run(1s);
  CHECK(rig.torque() == 30);
  rig.write(command_angle, 0);
  CHECK(rig.read(command_torque) == bla::not_active);
}

TEST_CASE("requirement 106: whether 0x00 to 0x02 tell what ArrayCommand brought is a setting",
          "[requirement-106][unproven]") {
  for (const bool shows : {true, false}) {
    MotionRig rig(
        MotionRig::cascade(fmt::format(R"(, "behaviour": {{"array_command_shows": {}}})", shows)));
    rig.write(command_angle, 100);
    rig.motion.command({command_angle, 300}, rig.now);
    CHECK(rig.read(command_angle) == (shows ? 300 : 100));
    rig.run(1s);
    CHECK(rig.stands_at(300)); // it obeys in any case
    rig.motion.command({command_speed, 60}, rig.now);
    rig.run(1s);
    CHECK(rig.rpm() == 60);
    CHECK(rig.read(command_speed) == (shows ? 60 : bla::not_active));
    rig.write(command_angle, 0);
    CHECK(rig.read(command_angle) == 0);
    rig.motion.command({command_angle, 300}, rig.now);
    rig.motion.initialize(rig.now);
    CHECK(rig.read(command_angle) == 0);
    rig.motion.command({command_angle, 300}, rig.now);
    rig.restart();
    CHECK(rig.read(command_angle) == rig.registers.value(command_angle));
  }
}

TEST_CASE("requirement 116: speed 0 and torque 0 stop and brake", "[requirement-116]") {
  for (const Address stop : {command_speed, command_torque}) {
    MotionRig rig(MotionRig::cascade());
    rig.write(command_speed, 100);
    rig.run(1s);
    rig.write(stop, 0);
    rig.around([](World& world) { world.load_percent = 25; });
    rig.run(1s);
    CHECK(rig.rpm() == 0); // without a brake 25 % would turn it
    CHECK(rig.torque() == 0);
  }
}

TEST_CASE("requirements 105, 117: without 0x25 speed and torque are ignored",
          "[requirement-105][requirement-117]") {
  MotionRig rig;
  rig.write(command_angle, 300);
  rig.run(1s);
  rig.write(command_speed, 60);
  rig.motion.command({command_torque, 60}, rig.now);
  rig.run(1s);
  CHECK(rig.read(command_angle) == 300);
  CHECK(rig.stands_at(300));
}

TEST_CASE("requirement 117: with 0x25 taken away a speed command no longer turns the shaft",
          "[requirement-117]") {
  MotionRig rig(MotionRig::cascade());
  rig.write(command_speed, 60);
  rig.run(1s);
  rig.write(speed_torque_control, 0);
  rig.run(1s);
  CHECK(rig.rpm() == 0);
}

TEST_CASE("requirement 117: a servo that takes speed without 0x25 keeps it but stands",
          "[requirement-117][unproven]") {
  MotionRig rig(MotionRig::with(R"("behaviour": {"ignores_disabled_commands": false})"));
  CHECK(rig.write(command_speed, 60) == 60);
  rig.run(1s);
  CHECK(rig.rpm() == 0);
  CHECK(rig.read(command_angle) == bla::not_active);
}

TEST_CASE("requirement 118: the speed limits hold for speed and angle commands",
          "[requirement-118]") {
  MotionRig rig(MotionRig::cascade());
  rig.write(speed_limit_cw, 40);
  rig.write(speed_limit_ccw, -20);
  rig.write(command_speed, 100);
  CHECK(greatest_rpm(rig, 1s) <= 41);
  CHECK(rig.rpm() == 40);
  CHECK(rig.noticed(fault::speed_cw));
  rig.write(command_speed, -100);
  rig.run(1s);
  CHECK(rig.rpm() == -20);
  CHECK(rig.noticed(fault::speed_ccw));
  CHECK_FALSE(rig.noticed(fault::speed_cw));
  rig.write(command_angle, 0);
  CHECK(greatest_rpm(rig, 3s) <= 41);
}

TEST_CASE("requirement 120: torque commands and a servo without 0x25 know no speed limit",
          "[requirement-120]") {
  MotionRig rig(MotionRig::cascade());
  rig.write(speed_limit_cw, 20);
  rig.write(command_torque, 80);
  rig.run(1s);
  CHECK(rig.rpm() > 100);
  MotionRig direct;
  direct.write(speed_limit_cw, 20);
  direct.write(command_angle, 1700);
  CHECK(greatest_rpm(direct, 1s) > 100);
}

TEST_CASE("requirements 119, 121: with 0x25 the torque limits hold for every command",
          "[requirement-119][requirement-121]") {
  const auto greatest_torque = [](Address command, std::int64_t value) {
    MotionRig rig(MotionRig::cascade());
    rig.write(torque_limit_cw, 30);
    rig.write(torque_limit_ccw, -10);
    rig.write(command, value);
    const auto most = greatest(rig, 500ms, [&] { return rig.torque(); });
    CHECK(rig.noticed(value > 0 ? fault::torque_cw : fault::torque_ccw));
    return most;
  };
  for (const Address command : {command_speed, command_torque}) {
    CHECK(greatest_torque(command, 90) == 30);
    CHECK(greatest_torque(command, -90) == 10);
  }
  CHECK(greatest_torque(command_angle, 1700) == 30);
  CHECK(greatest_torque(command_angle, -1700) == 10);
}

TEST_CASE("requirement 121: without 0x25 there is no torque limit", "[requirement-121]") {
  MotionRig rig;
  rig.write(torque_limit_cw, 30);
  rig.write(command_angle, 1700);
  CHECK(greatest(rig, 1s, [&] { return rig.torque(); }) == 100);
}

TEST_CASE("requirement 122: speed and torque commands know no angle limit", "[requirement-122]") {
  for (const Address command : {command_speed, command_torque}) {
    MotionRig rig(MotionRig::cascade());
    rig.write(angle_limit_cw, 100);
    rig.write(extended_angle, 1);
    rig.write(command, 60);
    rig.run(3s);
    CHECK(rig.angle() > 5000);
    CHECK(rig.noticed(fault::angle_cw));
  }
}

TEST_CASE("requirement 123: about 150 rpm at most, of a BLA21 at its rated supply",
          "[requirement-123]") {
  for (const char* model : {"BLA21-06U-A0", "BLA21-12U-AB", "BLA21-28U-AB"}) {
    MotionRig rig(fmt::format(R"("model": "{}", "ram": {{"speed_torque_control": "on"}},
        "rom": {{"soft_start": "off", "timeout_action": "hold"}})",
                              model));
    rig.write(command_speed, 300);
    rig.run(1s);
    CHECK(rig.rpm() >= 148);
    CHECK(rig.rpm() <= 152);
    rig.around([](World& world) { world.supply_decivolt = world.supply_decivolt * 3 / 4; });
    rig.run(1s);
    CHECK(rig.rpm() < 115); // 4.2: it depends on the supply
    rig.around([](World& world) { world.load_percent = -40; });
    rig.run(1s);
    CHECK(rig.rpm() < 60); // and on the load
  }
}

TEST_CASE("requirement 123: below 10 rpm it stands, or turns with 10 if it is set so",
          "[requirement-123][unproven]") {
  for (const char* slow : {"stands", "turns_slowest"}) {
    MotionRig rig(
        MotionRig::cascade(fmt::format(R"(, "behaviour": {{"slow_speed": "{}"}})", slow)));
    const bool turns = slow == std::string("turns_slowest");
    rig.write(command_speed, 9);
    rig.run(1s);
    CHECK(rig.rpm() == (turns ? 10 : 0));
    rig.write(command_speed, -1);
    rig.run(1s);
    CHECK(rig.rpm() == (turns ? -10 : 0));
    rig.write(command_speed, 10);
    rig.run(1s);
    CHECK(rig.rpm() == 10);
  }
}

TEST_CASE("requirements 124, 125: ten turns by speed, and the angle afterwards",
          "[requirement-124][requirement-125]") {
  for (const bool extended : {false, true}) {
    MotionRig rig(MotionRig::cascade());
    rig.write(smoothing, 0);
    rig.write(extended_angle, extended ? 1 : 0);
    rig.write(command_speed, 100);
    while (rig.shaft_decideg() < 10 * 3600 - 20) {
      rig.run(1ms);
      if (!extended) {
        REQUIRE(rig.angle() >= -1800);
        REQUIRE(rig.angle() <= 1799);
      }
    }
    rig.write(command_speed, 0);
    rig.run(500ms);
    CHECK(std::abs(rig.angle() - (extended ? 36'000 : 0)) < 50);
    rig.write(command_angle, 0);
    rig.run(50ms);
    CHECK((rig.rpm() < -20) == extended);
    rig.run(10s);
    CHECK(rig.stands_at(0));
    CHECK(std::abs(rig.shaft_decideg() - (extended ? 0 : 36'000)) <= 5);
  }
}

TEST_CASE("requirement 124: after an angle command the angle is extended, whatever 0x24 says",
          "[requirement-124]") {
  MotionRig rig(MotionRig::cascade());
  rig.write(angle_limit_cw, 4000);
  rig.write(command_angle, 4000);
  rig.run(4s);
  CHECK(rig.stands_at(4000));
  rig.write(command_speed, 0);
  CHECK(rig.stands_at(400)); // of a speed command within one turn
  rig.write(extended_angle, 1);
  CHECK(rig.stands_at(400)); // what was forgotten does not come back
}

TEST_CASE("requirement 126: speed and torque can be read in every mode", "[requirement-126]") {
  MotionRig direct;
  direct.write(command_angle, 1700);
  direct.run(100ms);
  CHECK(direct.rpm() > 50);
  CHECK(direct.torque() > 50);
  direct.write(command_angle, -1700);
  direct.run(200ms);
  CHECK(direct.rpm() < -50);
  CHECK(direct.torque() < -50);
  MotionRig cascade(MotionRig::cascade());
  cascade.write(command_torque, -40);
  cascade.run(1s);
  CHECK(cascade.torque() == -40);
  CHECK(cascade.rpm() < -40);
}

TEST_CASE("requirement 127: 0x23 mirrors commands and readings", "[requirement-127]") {
  MotionRig rig(MotionRig::cascade());
  rig.write(command_angle, 300);
  rig.run(1s);
  rig.motion.stop(rig.now);
  rig.write(reverse, 1);
  CHECK(std::abs(rig.angle() + 300) <= 5); // the same place
  rig.motion.start(rig.now);
  rig.write(command_angle, 450);
  rig.run(50ms);
  CHECK(rig.rpm() > 0);
  CHECK(rig.torque() != 0);
  CHECK(rig.motion.shaft().speed < 0);
  rig.run(2s);
  CHECK(rig.stands_at(450));
  CHECK(std::abs(rig.shaft_decideg() + 450) <= 5);
  rig.write(command_speed, 60);
  rig.run(1s);
  CHECK(rig.rpm() == 60);
  CHECK(rig.motion.shaft().speed < 0);
}

TEST_CASE("requirement 128: 0x44 shifts zero, and the seam with it", "[requirement-128]") {
  MotionRig rig;
  rig.write(origin, 450);
  rig.write(command_angle, 0);
  rig.run(2s);
  CHECK(rig.stands_at(0));
  CHECK(std::abs(rig.shaft_decideg() - 450) <= 5);
  const auto shown_at = [](std::int64_t shaft) {
    MotionRig turned(R"("model": "BLA21-12U-AB",
                        "rom": {"soft_start": "off", "torque_output": "off", "origin": "45deg"})");
    turned.around([&](World& world) { world.hand_decideg = shaft; });
    turned.run(2s);
    turned.restart();
    return turned.angle();
  };
  CHECK(shown_at(450) == 0);
  CHECK(shown_at(0) == -450);
  CHECK(shown_at(2249) == 1799);
  CHECK(shown_at(2250) == -1800);
  CHECK(shown_at(1800) == 1350);
}

TEST_CASE("requirement 183: with 0x44 the seam moves at once", "[requirement-183]") {
  const auto shown = [](std::int64_t shaft, std::int64_t new_origin, const char* turned = "off") {
    MotionRig rig(fmt::format(R"("model": "BLA21-12U-AB", "rom": {{"soft_start": "off",
        "torque_output": "off", "reverse": "{}"}}, "ram": {{"current_angle": "{}deg"}})",
                              turned, shaft / 10));
    CHECK(rig.angle() == shaft);
    rig.write(origin, new_origin);
    return rig.angle();
  };
  CHECK(shown(0, 450) == -450);
  CHECK(shown(-1700, 450) == 1450);
  CHECK(shown(-1700, 99) == -1799);
  CHECK(shown(-1700, 100) == -1800);
  CHECK(shown(-1700, 101) == 1799);
  CHECK(shown(1790, -10) == -1800);
  CHECK(shown(-1800, 1799) == 1);
  CHECK(shown(1700, 450, "on") == -1450);
  MotionRig turns; // more than one turn stays what it is
  turns.write(angle_limit_cw, 36'000);
  turns.write(command_angle, 9000);
  turns.run(5s);
  turns.write(torque_output, 1);
  const std::int64_t there = turns.angle();
  turns.write(origin, 450);
  CHECK(turns.angle() == there - 450);
}

TEST_CASE("requirement 129: smoothing levels the command, without it the shaft follows at once",
          "[requirement-129]") {
  const auto way = [](std::int64_t setting) {
    MotionRig rig;
    rig.write(smoothing, setting);
    rig.write(command_angle, 300);
    rig.run(30ms);
    const std::int64_t first = rig.angle();
    rig.run(2s);
    CHECK(rig.stands_at(300));
    return first;
  };
  CHECK(way(0) > 150);
  CHECK(way(1) < 100);
}

TEST_CASE("requirement 171: 0x2A limits the motor, also without 0x25", "[requirement-171]") {
  for (const char* control : {"on", "off"}) {
    MotionRig rig(fmt::format(R"("model": "BLA21-12U-AB", "ram": {{"speed_torque_control": "{}"}},
        "rom": {{"soft_start": "off", "timeout_action": "hold", "overcurrent_limit": "3.5A"}})",
                              control));
    rig.write(command_angle, 1700);
    CHECK(greatest(rig, 500ms, [&] { return rig.torque(); }) == 56); // 3.5 A of 6.3 A
    rig.write(overcurrent_limit, 70);
    rig.write(command_angle, -1700);
    CHECK(greatest(rig, 500ms, [&] { return std::abs(rig.torque()); }) >= 110); // 7 A
  }
}

TEST_CASE("requirement 172: a load deflects a held shaft by dead band and force over gain",
          "[requirement-172]") {
  const auto deflection = [](std::int64_t gain, std::int64_t boost) {
    MotionRig rig;
    rig.write(angle_p_gain, gain);
    rig.write(angle_boost, boost);
    rig.around([](World& world) { world.load_percent = 20; });
    rig.run(2s);
    CHECK(rig.rpm() == 0);
    return rig.angle();
  };
  CHECK(std::abs(deflection(40, 0) - 23) <= 1); // 0.3 deg, and 20 % at 1 % per 0.1 deg
  CHECK(std::abs(deflection(80, 0) - 13) <= 1);
  CHECK(std::abs(deflection(40, 100) - 13) <= 1); // 10 % of it by boost
}

TEST_CASE("requirement 172: inside the dead band nothing happens", "[requirement-172]") {
  MotionRig rig;
  rig.write(angle_dead_band, 50);
  rig.write(command_angle, 50);
  rig.run(1s);
  CHECK(rig.angle() == 0);
  rig.write(command_angle, 60);
  rig.run(1s);
  CHECK(rig.angle() > 0);
}

TEST_CASE("requirement 172: the boost of a firmware without 0x2F is none", "[requirement-172]") {
  const auto torque = [](int firmware) {
    MotionRig rig(fmt::format(R"("model": "BLA15-06U-A0", "firmware_version": {},
        "rom": {{"soft_start": "off", "timeout_action": "hold", "smoothing": "off"}})",
                              firmware));
    rig.around([](World& world) { world.stuck = true; });
    rig.write(command_angle, 50);
    rig.run(100ms);
    return rig.torque();
  };
  CHECK(torque(1400) - torque(1010) == 3);
}

TEST_CASE("requirement 173: 0x2D brakes earlier, with an angle command and 0x25 only",
          "[requirement-173]") {
  const auto after = [](bool cascade, Address command, std::int64_t value, std::int64_t gain) {
    MotionRig rig(cascade ? MotionRig::cascade() : MotionRig::calm);
    rig.write(smoothing, 0);
    rig.write(angle_d_gain, gain);
    rig.write(command, value);
    rig.run(60ms);
    return rig.motion.shaft();
  };
  CHECK(after(true, command_angle, 450, 100).angle < after(true, command_angle, 450, 0).angle);
  CHECK(after(false, command_angle, 450, 100) == after(false, command_angle, 450, 0));
  CHECK(after(true, command_speed, 45, 100) == after(true, command_speed, 45, 0));
}

TEST_CASE("a stuck shaft keeps the motor pushing, and goes on when it is free") {
  MotionRig rig;
  rig.around([](World& world) { world.stuck = true; });
  rig.write(command_angle, 47);
  rig.run(1s);
  CHECK(rig.angle() == 0);
  CHECK(rig.torque() == 44); // 4.4 deg beyond the dead band, 1 % for 0.1 deg
  rig.around([](World& world) { world.stuck = false; });
  rig.run(1s);
  CHECK(rig.stands_at(47));
}

TEST_CASE("the greatest numbers that registers and world may have are computed right") {
  for (const char* control : {"on", "off"}) {
    MotionRig rig(fmt::format(R"("model": "BLA21-12U-AB", "ram": {{"speed_torque_control": "{}"}},
        "rom": {{"soft_start": "off", "timeout_action": "hold", "angle_p_gain": 100,
                 "angle_d_gain": 100, "0x38": 360000000, "0x39": -360000000}})",
                              control));
    rig.write(angle_boost, 100);
    rig.write(command_angle, 360'000'000);
    rig.run(1s);
    CHECK(rig.rpm() > 140);
    rig.around([](World& world) { world.load_percent = -1000; });
    rig.run(1h);
    CHECK(rig.angle() < -100'000'000);
    CHECK(rig.rpm() == -300); // all that 0x09 can show
    rig.around([](World& world) {
      world.load_percent = 1000;
      world.hand_decideg = 360'000'000;
    });
    rig.run(1s);
    CHECK(rig.rpm() == 0);
    CHECK(rig.angle() % 3600 == 0);
  }
}

TEST_CASE("looking more often changes nothing") {
  const auto life = [](Duration look) {
    MotionRig rig(MotionRig::cascade());
    const auto pass = [&](Duration duration) {
      const Time end = rig.now + duration;
      while (rig.now < end) {
        rig.run(std::min(look, end - rig.now));
      }
    };
    rig.write(command_angle, 450);
    pass(1234567us);
    rig.around([](World& world) { world.load_percent = 17; });
    pass(100ms);
    rig.write(command_speed, -77);
    pass(3s);
    rig.write(command_torque, 5);
    pass(789us);
    return rig.motion.shaft();
  };
  const Shaft once = life(1h);
  CHECK(once.angle != 0);
  CHECK(life(137us) == once);
  CHECK(life(1ms) == once);
  CHECK(life(10ms) == once);
}

namespace {

/// Something that happens by chance to a servo or around it.
void disturb(MotionRig& rig, Random& random) {
  const auto up_to = [&](std::int64_t most) {
    return static_cast<std::int64_t>(random.next() % static_cast<std::uint64_t>(most + 1));
  };
  const auto around = [&](std::int64_t most) { return up_to(2 * most) - most; };
  constexpr std::array settings{torque_output,  smoothing,      reverse,
                                extended_angle, timeout_action, speed_torque_control,
                                pwm_mode};
  switch (up_to(9)) {
  case 0: rig.write(command_angle, around(3000)); break;
  case 1: rig.write(command_speed, around(300)); break;
  case 2: rig.motion.command({command_torque, around(100)}, rig.now); break;
  case 3: rig.write(settings.at(random.next() % settings.size()), up_to(2)); break;
  case 4: rig.write(timeout_time, 1 + up_to(1500)); break;
  case 5: rig.write(origin, around(1700)); break;
  case 6: rig.around([&](World& world) { world.load_percent = around(60); }); break;
  case 7: rig.around([&](World& world) { world.board_celsius = 25 + up_to(70); }); break;
  case 8:
    rig.around([&](World& world) {
      world.hand_decideg = up_to(1) == 0 ? std::optional(around(1800)) : std::nullopt;
    });
    break;
  default:
    rig.around([&](World& world) {
      world.pulse_us = up_to(3) != 0 ? std::optional(700 + up_to(1700)) : std::nullopt;
    });
  }
}

} // namespace

TEST_CASE("whatever happens, looking more often changes nothing") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    INFO(seed);
    const auto life = [&](Duration look) {
      Random random(seed);
      MotionRig rig(R"("model": "BLA21-12U-AB")");
      for (int i = 0; i < 60; ++i) {
        const Time end = rig.now + random.between(1us, 700ms);
        while (rig.now < end) {
          rig.run(std::min(look, end - rig.now));
        }
        disturb(rig, random);
      }
      std::vector<std::int64_t> all{rig.motion.shaft().angle, rig.motion.shaft().speed};
      for (std::uint8_t address = 0; address < 0x60; ++address) {
        all.push_back(rig.registers.value(Address(address)));
      }
      return all;
    };
    CHECK(life(1h) == life(1700us));
  }
}

TEST_CASE("a servo that nobody looks at for a day costs nothing") {
  MotionRig rig(R"("model": "BLA21-12U-AB", "rom": {"timeout_action": "hold"})");
  rig.write(command_angle, 450);
  for (int year = 0; year < 100; ++year) {
    rig.run(365 * 24h);
  }
  CHECK(rig.stands_at(450));
}
