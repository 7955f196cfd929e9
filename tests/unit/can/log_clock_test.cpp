#include "blactl/can/log_clock.hpp"

#include "catch.hpp"

#include <chrono>
#include <initializer_list>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;

namespace {

using Stamp = LogLine::Stamp;
using Times = std::vector<Duration>;

/// The bus clock after each of these stamps.
Times times(LogClock& clock, Stamp stamp, std::initializer_list<Duration> stamps) {
  Times found;
  for (const Duration at : stamps) {
    LogLine line;
    line.stamp = stamp;
    line.at = WallTime(at);
    clock.pass(line);
    found.push_back(clock.now().time_since_epoch());
  }
  return found;
}

} // namespace

TEST_CASE("the clock of a log begins at 0 and tells the wall time of the stamp") {
  LogClock clock;
  CHECK(times(clock, Stamp::absolute, {1000s, 1001s, 1001s + 1us}) == Times{0s, 1s, 1s + 1us});
  CHECK(clock.wall() == WallTime(1001s + 1us));
}

TEST_CASE("a stamp before the last one does not turn the clock back, nor stop it") {
  LogClock clock;
  CHECK(times(clock, Stamp::absolute, {1000s, 1002s, 500s, 501s}) == Times{0s, 2s, 2s, 3s});
  CHECK(clock.wall() == WallTime(501s));
}

TEST_CASE("stamps from the first frame on, out of order a little") {
  LogClock clock;
  CHECK(times(clock, Stamp::relative, {0s, 1s, 999ms, 2s}) == Times{0s, 1s, 1s, 2001ms});
  CHECK(clock.wall() == WallTime(2s));
}

TEST_CASE("stamps from the last frame on are added up") {
  LogClock clock;
  CHECK(times(clock, Stamp::relative, {0us, 130us, 10ms, 130us, 10ms, 0us}) ==
        Times{0us, 130us, 10ms, 10130us, 20130us, 20130us});
  CHECK(clock.wall() == WallTime(20130us));
  LogClock regular;
  CHECK(times(regular, Stamp::relative, {0ms, 202ms, 141ms, 150ms}) ==
        Times{0ms, 202ms, 343ms, 493ms});
}

TEST_CASE("without stamps time stands still") {
  LogClock clock;
  CHECK(times(clock, Stamp::none, {0s, 0s}) == Times{0s, 0s});
  CHECK(times(clock, Stamp::absolute, {1000s, 1001s}) == Times{0s, 1s});
  CHECK(times(clock, Stamp::none, {0s}) == Times{1s});
  CHECK(times(clock, Stamp::absolute, {1003s}) == Times{3s});
}

TEST_CASE("logs of two kinds in one file begin anew without a jump") {
  LogClock clock;
  CHECK(times(clock, Stamp::absolute, {1000s, 1001s}) == Times{0s, 1s});
  CHECK(times(clock, Stamp::relative, {0s, 2s}) == Times{1s, 3s});
  CHECK(times(clock, Stamp::absolute, {5000s, 5001s}) == Times{3s, 4s});
}

TEST_CASE("absurd stamps do not overflow the clock") {
  LogClock clock;
  for (int i = 0; i < 1000; ++i) {
    times(clock, Stamp::absolute, {0s, 99'999'999'999s});
  }
  CHECK(clock.now() < never);
  CHECK(clock.now() + 100h > clock.now());
  LogClock adding;
  times(adding, Stamp::relative, {100s, 0s});
  for (int i = 0; i < 1000; ++i) {
    times(adding, Stamp::relative, {999'999'999s});
  }
  CHECK(adding.now().time_since_epoch() == 999'999'999'000s);
  for (int i = 0; i < 20'000; ++i) {
    times(adding, Stamp::relative, {999'999'999s});
  }
  CHECK(adding.now() < never);
  CHECK(adding.wall() > WallTime());
}
