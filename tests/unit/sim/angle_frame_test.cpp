#include "blactl/sim/servo/angle_frame.hpp"

#include "unit/sim/support.hpp"

using namespace blactl::sim;

namespace {

AngleFrame frame(bool reversed, std::int64_t origin = 0) {
  AngleFrame frame;
  frame.set(reversed, origin);
  return frame;
}

Shaft at(std::int64_t decideg) {
  return {.angle = decideg * angle_per_decideg, .speed = 7};
}

} // namespace

TEST_CASE("requirements 127, 128: the servo counts from 0x44, mirrored by 0x23",
          "[requirement-127][requirement-128]") {
  CHECK(frame(false).decideg(at(450)) == 450);
  CHECK(frame(false, 450).decideg(at(450)) == 0);
  CHECK(frame(false, 450).decideg(at(0)) == -450);
  CHECK(frame(true).decideg(at(450)) == -450);
  CHECK(frame(true, 450).decideg(at(0)) == 450);
  CHECK(frame(true).position(at(0)).speed == -7);
  for (const bool reversed : {false, true}) {
    const AngleFrame one = frame(reversed, -100);
    CHECK(one.decideg({.angle = one.shaft_angle(1234)}) == 1234);
  }
}

TEST_CASE("requirement 46: after a wrap the angle is -180.0 to +179.9 deg, of the same place",
          "[requirement-46]") {
  for (const bool reversed : {false, true}) {
    for (const std::int64_t shaft : {0, 1799, 1800, -1800, -1801, 2700, -2700, 36'000, -35'999}) {
      AngleFrame one = frame(reversed, 300);
      const std::int64_t before = one.decideg(at(shaft));
      one.wrap(at(shaft));
      const std::int64_t after = one.decideg(at(shaft));
      INFO(shaft << " " << reversed);
      CHECK(after >= -1800);
      CHECK(after <= 1799);
      CHECK((before - after) % 3600 == 0);
      one.wrap(at(shaft));
      CHECK(one.decideg(at(shaft)) == after);
    }
  }
}

TEST_CASE("requirement 183: a change of the origin keeps an angle of one turn in one turn",
          "[requirement-183]") {
  for (const bool reversed : {false, true}) {
    for (const std::int64_t shaft : {0, 1799, -1700, 1000, -1000}) {
      for (const std::int64_t origin : {-1800, -1000, 1000, 1799}) {
        AngleFrame one = frame(reversed);
        one.change(reversed, origin, at(shaft));
        INFO(shaft << " " << origin << " " << reversed);
        CHECK(one.decideg(at(shaft)) >= -1800);
        CHECK(one.decideg(at(shaft)) <= 1799);
        AngleFrame beyond = frame(reversed);
        beyond.change(reversed, origin, at(shaft + 7200));
        CHECK(beyond.decideg(at(shaft + 7200)) == one.sign() * (shaft + 7200 - origin));
      }
    }
  }
}

TEST_CASE("an angle is rounded to the nearest 0.1 deg before it is wrapped") {
  AngleFrame one = frame(false);
  const Shaft seam{.angle = 1799 * angle_per_decideg + angle_per_decideg / 2};
  one.wrap(seam);
  CHECK(one.decideg(seam) == -1800);
  CHECK(frame(false).decideg({.angle = angle_per_decideg / 2 - 1}) == 0);
  CHECK(frame(false).decideg({.angle = -angle_per_decideg / 2}) == 0);
  CHECK(frame(false).decideg({.angle = -angle_per_decideg / 2 - 1}) == -1);
}
