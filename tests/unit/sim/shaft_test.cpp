#include "blactl/sim/servo/shaft.hpp"

#include "unit/sim/support.hpp"

using namespace blactl::sim;

namespace {

constexpr std::int64_t full_speed = 150 * speed_per_rpm;

Shaft pushed(Drive::Kind kind, std::int64_t push, const World& world, int milliseconds) {
  Shaft shaft;
  for (int i = 0; i < milliseconds; ++i) {
    shaft.step(kind, push, world, full_speed);
  }
  return shaft;
}

World with_load(std::int64_t percent) {
  World world;
  world.load_percent = percent;
  return world;
}

} // namespace

TEST_CASE("all effort turns the shaft at full speed, with the sign of the effort") {
  CHECK(pushed(Drive::Kind::on, full_effort, {}, 100).speed / speed_per_rpm == 149);
  CHECK(pushed(Drive::Kind::on, -full_effort, {}, 100).speed / speed_per_rpm == -149);
  CHECK(pushed(Drive::Kind::on, full_effort, {}, 1000).angle / angle_per_decideg > 8900);
}

TEST_CASE("a brake holds more load than a motor without current, and that more than none") {
  for (const auto& [kind, holds, slips] :
       {std::tuple{Drive::Kind::brake, 30, 31}, std::tuple{Drive::Kind::off, 5, 6}}) {
    CHECK(pushed(kind, 0, with_load(holds), 1000) == Shaft{});
    CHECK(pushed(kind, 0, with_load(slips), 1000).angle > 0);
    CHECK(pushed(kind, 0, with_load(-slips), 1000).angle < 0);
  }
}

TEST_CASE("without a push the shaft comes to a stand") {
  Shaft shaft{.speed = full_speed};
  for (int i = 0; i < 100; ++i) {
    shaft.step(Drive::Kind::off, 0, {}, full_speed);
  }
  CHECK(shaft.speed == 0);
  CHECK(shaft.angle > 0);
}

TEST_CASE("a stuck shaft does not turn, whatever pushes") {
  World world;
  world.stuck = true;
  CHECK(pushed(Drive::Kind::on, full_effort, world, 1000) == Shaft{});
}

TEST_CASE("a hand turns the shaft the nearest way, stronger than the motor, and holds it") {
  World world;
  world.hand_decideg = 900;
  const Shaft held = pushed(Drive::Kind::on, -full_effort, world, 1000);
  CHECK(held.angle == 900 * angle_per_decideg);
  CHECK(held.speed == 0);
  world.hand_decideg = 2700;
  CHECK(pushed(Drive::Kind::off, 0, world, 1000).angle == -900 * angle_per_decideg);
  world.hand_decideg = -2700;
  CHECK(pushed(Drive::Kind::off, 0, world, 1000).angle == 900 * angle_per_decideg);
  CHECK(pushed(Drive::Kind::off, 0, world, 100).angle == 360 * angle_per_decideg); // 60 rpm
}
