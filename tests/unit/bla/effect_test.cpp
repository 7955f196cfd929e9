#include "blactl/bla/effect.hpp"

#include "catch.hpp"

#include <cstdint>

using namespace blactl;
using namespace blactl::bla;

TEST_CASE("a restart moves the shaft where torque is on, and softly where that is set") {
  constexpr int on = 0; // 0x20 counts upside down (4.13)
  constexpr int off = 1;
  const auto motion = [](std::int64_t torque, std::int64_t soft) {
    return restart_motion({{address::torque_output, torque}, {address::soft_start, soft}});
  };
  CHECK(motion(on, 0) == RestartMotion::hard);
  CHECK(motion(on, 1) == RestartMotion::soft);
  CHECK(motion(off, 0) == RestartMotion::none);
  CHECK(motion(off, 1) == RestartMotion::none);
  CHECK(restart_motion({{address::torque_output, off}}) == RestartMotion::none);
  CHECK(restart_motion({}) != RestartMotion::none); // it may be on
}
