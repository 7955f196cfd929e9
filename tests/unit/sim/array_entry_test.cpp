#include "blactl/sim/servo/array_entry.hpp"

#include "unit/sim/support.hpp"

#include <limits>

using namespace blactl::sim;
using blactl::dronecan::ArrayCommand;
using blactl::dronecan::from_float16;
using blactl::dronecan::to_float16;

namespace {

/// As it arrives: through a float16.
std::optional<MotionCommand> command(std::uint8_t type, float value,
                                     const Behaviour& behaviour = {}) {
  return motion_command({1, type, from_float16(to_float16(value))}, behaviour);
}

constexpr auto angle = blactl::bla::address::command_angle;
constexpr auto speed = blactl::bla::address::command_speed;
constexpr auto torque = blactl::bla::address::command_torque;

} // namespace

TEST_CASE("requirement 100: UNITLESS -1 to +1 is -180 to +180 deg, exact to 0.1 deg",
          "[requirement-100]") {
  CHECK(command(0, 1) == MotionCommand{angle, 1800});
  CHECK(command(0, -1) == MotionCommand{angle, -1800});
  CHECK(command(0, 0) == MotionCommand{angle, 0});
  for (std::int64_t decideg = -1800; decideg <= 1800; ++decideg) {
    const auto heard = command(0, static_cast<float>(decideg) / 1800);
    REQUIRE(heard == MotionCommand{angle, decideg});
  }
}

TEST_CASE("requirement 101: POSITION 0.001 is 0.1 deg, exact up to 200 deg", "[requirement-101]") {
  CHECK(command(1, 0.45F) == MotionCommand{angle, 450});
  for (std::int64_t decideg = -2000; decideg <= 2000; ++decideg) {
    const auto heard = command(1, static_cast<float>(decideg) / 1000);
    REQUIRE(heard == MotionCommand{angle, decideg});
  }
  CHECK(command(1, 65504) == MotionCommand{angle, 65'504'000});
}

TEST_CASE("requirements 102, 103: FORCE in %, SPEED in rpm, positive is CW",
          "[requirement-102][requirement-103]") {
  CHECK(command(2, 55) == MotionCommand{torque, 55});
  CHECK(command(2, -100) == MotionCommand{torque, -100});
  CHECK(command(3, 120) == MotionCommand{speed, 120});
  CHECK(command(3, -0.6F) == MotionCommand{speed, -1});
}

TEST_CASE("requirement 104: other types are ignored", "[requirement-104]") {
  for (int type = 4; type < 256; ++type) {
    CHECK_FALSE(command(static_cast<std::uint8_t>(type), 1));
  }
}

TEST_CASE("requirement 107: what is no number is ignored, or taken for 0 if the servo is set so",
          "[requirement-107][unproven]") {
  Behaviour zero;
  zero.not_a_number = NotANumber::zero;
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    CHECK_FALSE(command(1, value));
    CHECK(command(1, value, zero) == MotionCommand{angle, 0});
    CHECK_FALSE(command(4, value, zero));
  }
}

TEST_CASE("requirement 100: UNITLESS beyond 1 is limited by 0x38 and 0x39, by 180 deg, or ignored",
          "[requirement-100][unproven]") {
  Behaviour clamps;
  clamps.beyond_unitless = BeyondUnitless::clamp;
  Behaviour ignores;
  ignores.beyond_unitless = BeyondUnitless::ignore;
  for (const float sign : {1.0F, -1.0F}) {
    const auto half_turn = static_cast<std::int64_t>(1800 * sign);
    CHECK(command(0, 2 * sign) == MotionCommand{angle, 2 * half_turn});
    CHECK(command(0, 2 * sign, clamps) == MotionCommand{angle, half_turn});
    CHECK_FALSE(command(0, 2 * sign, ignores));
    CHECK(command(0, sign, ignores) == MotionCommand{angle, half_turn}); // not beyond
    CHECK(command(1, 2 * sign, ignores) == MotionCommand{angle, 2000 * static_cast<int>(sign)});
  }
}

TEST_CASE("requirements 98, 99: a command is for the servo with its ID, 255 for every one",
          "[requirement-98][requirement-99]") {
  CHECK(addresses({7, 1, 0}, 7, {}));
  CHECK_FALSE(addresses({7, 1, 0}, 8, {}));
  CHECK(addresses({255, 1, 0}, 8, {}));
  CHECK(addresses({0, 1, 0}, 0, {}));
  CHECK_FALSE(addresses({0, 1, 0}, 1, {}));
}
