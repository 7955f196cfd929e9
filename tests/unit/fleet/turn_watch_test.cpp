#include "blactl/fleet/live/turn_watch.hpp"

#include "catch.hpp"

#include <chrono>

using namespace blactl;
using namespace blactl::fleet;
using namespace std::chrono_literals;

TEST_CASE("a shaft has turned when it is two degrees from its rest, and for some seconds after") {
  TurnWatch watch;
  const Time begin{1s};
  watch.take(300, begin);
  watch.take(319, begin + 1s);
  watch.take(281, begin + 2s);
  CHECK_FALSE(watch.has_turned(begin + 2s));
  watch.take(280, begin + 3s);
  CHECK(watch.has_turned(begin + 3s));
  CHECK(watch.has_turned(begin + 7s));
  CHECK_FALSE(watch.has_turned(begin + 8s));
}

TEST_CASE("a shaft that turns on is told on, and rests where it stops") {
  TurnWatch watch;
  const Time begin{1s};
  for (int i = 0; i <= 100; ++i) { // half a degree a tenth of a second
    watch.take(i * 5, begin + i * 100ms);
  }
  CHECK(watch.has_turned(begin + 14s));
  watch.take(510, begin + 20s);
  CHECK_FALSE(watch.has_turned(begin + 20s));
}

TEST_CASE("after a restart an angle is compared with nothing before it") {
  TurnWatch watch;
  watch.take(0, Time{1s});
  watch.forget();
  watch.take(900, Time{2s});
  CHECK_FALSE(watch.has_turned(Time{2s}));
}
