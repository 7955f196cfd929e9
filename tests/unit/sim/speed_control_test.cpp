// What 0x2A and 0x30-0x33 do to the motion (4.20, 4.25-4.28).

#include "unit/sim/motion_rig.hpp"

#include <vector>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using namespace blactl::sim::address;
using testing::MotionRig;

namespace {

struct Setting {
  Address address;
  std::int64_t value;
};

/// One that turns at 60 rpm with a setting, from now on.
struct Turning : MotionRig {
  explicit Turning(std::initializer_list<Setting> settings) : MotionRig(MotionRig::cascade()) {
    write(smoothing, 0);
    for (const Setting& setting : settings) {
      CHECK(write(setting.address, setting.value) == setting.value);
    }
    write(command_speed, 60);
  }

  void load(std::int64_t percent) {
    around([&](World& world) { world.load_percent = percent; });
  }

  std::int64_t after(Duration duration) {
    run(duration);
    return rpm();
  }
};

/// The greatest torque of a servo that is blocked.
std::int64_t blocked_torque(const char* control, std::int64_t decampere) {
  MotionRig rig(
      fmt::format(R"({}, "ram": {{"speed_torque_control": "{}"}})", MotionRig::calm, control));
  rig.around([](World& world) { world.stuck = true; });
  CHECK(rig.write(overcurrent_limit, decampere) == decampere);
  rig.write(command_angle, 1700);
  rig.run(1s);
  return rig.torque();
}

} // namespace

TEST_CASE("requirement 181: with a smaller 0x30 it comes to its speed later, and gives way more",
          "[requirement-181]") {
  const auto start = [](std::int64_t gain) {
    Turning rig({{speed_p_gain, gain}});
    return rig.after(4ms);
  };
  CHECK(start(1) < start(10));
  CHECK(start(10) < start(50));
  const auto sag = [](std::int64_t gain) {
    Turning rig({{speed_p_gain, gain}, {speed_i_gain, 0}});
    rig.load(-40);
    return 60 - rig.after(1s);
  };
  CHECK(sag(100) < sag(50));
  CHECK(sag(50) + 5 < sag(10));
}

TEST_CASE("requirement 181: 0x31 makes up for a load, the faster the larger; 0 does not",
          "[requirement-181]") {
  const auto under_load = [](std::int64_t gain, Duration duration) {
    Turning rig({{speed_i_gain, gain}});
    rig.run(500ms);
    rig.load(-40);
    return rig.after(duration);
  };
  CHECK(std::abs(under_load(1, 1s) - 60) <= 1);
  CHECK(under_load(0, 1s) < 50);
  CHECK(under_load(1, 20ms) < under_load(10, 20ms));
}

TEST_CASE("requirement 181: 0x32 leaves small deviations alone", "[requirement-181]") {
  const auto under_load = [](std::int64_t dead_band) {
    Turning rig({{speed_dead_band, dead_band}});
    rig.run(1s);
    rig.load(-20);
    rig.run(2s);
    return rig.motion.shaft().speed * 10 / speed_per_rpm; // 0.1 rpm
  };
  CHECK(std::abs(under_load(0) - 600) <= 3);
  CHECK(std::abs(under_load(2000) - 580) <= 4); // 2 rpm short
}

TEST_CASE("requirement 181: 0x33 bounds what 0x31 makes up for", "[requirement-181]") {
  const auto under_load = [](std::int64_t limit) {
    Turning rig({{speed_i_limit, limit}});
    rig.load(-40);
    return rig.after(2s);
  };
  CHECK(std::abs(under_load(2000) - 60) <= 1);
  CHECK(under_load(200) < 55);
  CHECK(under_load(1) < under_load(200));
}

TEST_CASE("requirement 181: 0x30 to 0x33 leave torque commands and a servo without 0x25 alone",
          "[requirement-181]") {
  const auto moved = [](const char* control, Address command, std::int64_t value, bool changed) {
    MotionRig rig(
        fmt::format(R"({}, "ram": {{"speed_torque_control": "{}"}})", MotionRig::calm, control));
    if (changed) {
      rig.write(speed_p_gain, 5);
      rig.write(speed_i_gain, 100);
      rig.write(speed_dead_band, 2000);
      rig.write(speed_i_limit, 1);
    }
    rig.write(command, value);
    rig.run(200ms);
    return rig.motion.shaft();
  };
  CHECK(moved("on", command_torque, 40, true) == moved("on", command_torque, 40, false));
  CHECK(moved("off", command_angle, 900, true) == moved("off", command_angle, 900, false));
  CHECK_FALSE(moved("on", command_angle, 900, true) == moved("on", command_angle, 900, false));
}

TEST_CASE("requirement 181: any gains keep the shaft believable", "[requirement-181]") {
  for (const std::int64_t gain : {1, 100}) {
    for (const std::int64_t integral : {0, 1, 100}) {
      for (const std::int64_t limit : {1, 2000, 500'000}) {
        INFO(gain << " " << integral << " " << limit);
        Turning rig({{speed_p_gain, gain}, {speed_i_gain, integral}, {speed_i_limit, limit}});
        rig.run(2s);
        CHECK(std::abs(rig.rpm()) <= 160);
        rig.write(command_speed, 0);
        CHECK(rig.after(500ms) == 0);
      }
    }
  }
}

TEST_CASE("requirement 182: the greatest torque is in proportion to 0x2A",
          "[requirement-182][requirement-171]") {
  for (const char* control : {"off", "on"}) { // 6.3 A is usual
    CHECK(blocked_torque(control, 35) == 56);
    CHECK(blocked_torque(control, 63) == 100);
    CHECK(blocked_torque(control, 70) == 111);
  }
}

TEST_CASE("requirement 182: more 0x2A holds more load, and is no faster without one",
          "[requirement-182][requirement-123]") {
  const auto holds = [](std::int64_t decampere, std::int64_t percent) {
    MotionRig rig;
    rig.write(overcurrent_limit, decampere);
    rig.around([&](World& world) { world.load_percent = percent; });
    rig.run(2s);
    return rig.rpm() == 0;
  };
  CHECK(holds(63, 99));
  CHECK_FALSE(holds(63, 105));
  CHECK(holds(70, 105));
  MotionRig rig;
  rig.write(overcurrent_limit, 70);
  rig.write(angle_limit_cw, 36'000);
  rig.write(command_angle, 30'000);
  rig.run(1s);
  CHECK(rig.rpm() <= 150);
  CHECK(rig.rpm() >= 145);
}
