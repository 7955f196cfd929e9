#include "blactl/sim/servo/controller.hpp"

#include "unit/sim/support.hpp"

using namespace blactl::sim;

namespace {

Tuning plain() {
  Tuning tuning;
  tuning.p_gain = 40;
  tuning.full_speed = 150 * speed_per_rpm;
  tuning.speed_cw = 300 * speed_per_rpm;
  tuning.speed_ccw = -tuning.speed_cw;
  tuning.effort_cw = full_effort;
  tuning.effort_ccw = -full_effort;
  return tuning;
}

constexpr std::int64_t degree = 10 * angle_per_decideg;

} // namespace

TEST_CASE("requirement 172: force is gain times deviation beyond the dead band",
          "[requirement-172]") {
  Tuning tuning = plain();
  CHECK(angle_effort(degree, tuning) == 10 * effort_per_percent);
  CHECK(angle_effort(-degree, tuning) == -10 * effort_per_percent);
  tuning.p_gain = 80;
  CHECK(angle_effort(degree, tuning) == 20 * effort_per_percent);
  tuning.dead_band = degree / 2;
  CHECK(angle_effort(degree / 2, tuning) == 0);
  CHECK(angle_effort(-degree / 2, tuning) == 0);
  CHECK(angle_effort(degree, tuning) == 10 * effort_per_percent); // from zero, same slope
}

TEST_CASE("requirements 172, 174: boost is added at once, 100 is 10 %, all together at most 100 %",
          "[requirement-172][requirement-174]") {
  Tuning tuning = plain();
  tuning.boost = 10 * effort_per_percent;
  CHECK(angle_effort(0, tuning) == 0);
  CHECK(angle_effort(1, tuning) == 10 * effort_per_percent);
  CHECK(angle_effort(-1, tuning) == -10 * effort_per_percent);
  CHECK(angle_effort(degree, tuning) == 20 * effort_per_percent);
  CHECK(angle_effort(100 * degree, tuning) == full_effort);
  CHECK(angle_effort(-100 * degree, tuning) == -full_effort);
}

TEST_CASE("requirement 172: boost may work inside the dead band", "[requirement-172][unproven]") {
  Tuning tuning = plain();
  tuning.boost = 10 * effort_per_percent;
  tuning.dead_band = degree;
  CHECK(angle_effort(degree / 2, tuning) == 0);
  tuning.boost_in_dead_band = true;
  CHECK(angle_effort(degree / 2, tuning) == tuning.boost);
  CHECK(angle_effort(-degree / 2, tuning) == -tuning.boost);
  CHECK(angle_effort(0, tuning) == 0);
}

TEST_CASE("requirement 129: without smoothing a step of the command is followed at once",
          "[requirement-129]") {
  const Aim aim{Mode::angle, 90 * degree};
  Tuning tuning = plain();
  CHECK(Controller().step(aim, {}, tuning).effort == full_effort);
  tuning.smooth = true;
  Controller smooth;
  std::int64_t before = 0;
  for (int i = 0; i < 5; ++i) {
    const std::int64_t effort = smooth.step(aim, {}, tuning).effort;
    CHECK(effort > before);
    CHECK(effort < full_effort);
    before = effort;
  }
  tuning.p_gain = 100;
  for (int i = 0; i < 1000; ++i) {
    before = smooth.step(aim, {90 * degree, 0}, tuning).effort;
  }
  CHECK(before == 0); // it comes to the very command
}

TEST_CASE("requirement 116: speed 0 and torque 0 brake", "[requirement-116]") {
  Tuning tuning = plain();
  tuning.cascade = true;
  CHECK(Controller().step({Mode::speed, 0}, {}, tuning).kind == Drive::Kind::brake);
  CHECK(Controller().step({Mode::torque, 0}, {}, tuning).kind == Drive::Kind::brake);
  CHECK(Controller().step({Mode::angle, 0}, {}, tuning).kind == Drive::Kind::on);
}

TEST_CASE("the speed control builds up what a load takes, but not what it cannot give") {
  Tuning tuning = plain();
  tuning.cascade = true;
  Controller controller;
  const Aim aim{Mode::speed, 60 * speed_per_rpm};
  const std::int64_t first = controller.step(aim, {}, tuning).effort;
  for (int i = 0; i < 1000; ++i) {
    (void)controller.step(aim, {0, 50 * speed_per_rpm}, tuning);
  }
  CHECK(first == full_effort);
  CHECK(controller.step(aim, {0, 50 * speed_per_rpm}, tuning).effort == full_effort);
  CHECK(controller.step(aim, {0, 120 * speed_per_rpm}, tuning).effort < 0);
}

TEST_CASE("what the speed control built up is gone with another kind of command") {
  Tuning tuning = plain();
  tuning.cascade = true;
  Controller used;
  for (int i = 0; i < 100; ++i) {
    (void)used.step({Mode::speed, 60 * speed_per_rpm}, {0, 50 * speed_per_rpm}, tuning);
  }
  const Aim aim{Mode::angle, degree};
  CHECK(used.step(aim, {}, tuning) == Controller().step(aim, {}, tuning));
}
