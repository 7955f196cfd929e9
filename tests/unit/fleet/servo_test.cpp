#include "blactl/fleet/servo.hpp"

#include "catch.hpp"

#include <chrono>
#include <cstdint>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace std::chrono_literals;

TEST_CASE("an uptime proves that a unit has run since, or proves nothing") {
  struct Row {
    Duration since_ago;
    std::uint32_t uptime_s;
    bool proves;
  };

  const auto row = GENERATE(values<Row>({
      {0s, 0, false}, // near 0 whole seconds show no restart
      {0s, 1, false},
      {0s, 2, true},
      {1s, 1, false},
      {1s, 2, true},
      {1959ms, 2, true},
      {1961ms, 2, false}, // its clock may be fast by 2 %
      {2s, 2, false},
      {2s, 3, true},
      {100s, 100, false}, // it may have started at that very moment
      {100s, 102, false},
      {100s, 103, true},
      {10h, 36'000, false},
      {10h, 36'734, false},
      {10h, 36'735, true},
      {1s, 0xFFFF'FFFF, true},
  }));
  const Time now{1'000'000s};
  CAPTURE(row.uptime_s, row.since_ago.count());
  CHECK(has_run_since(now - row.since_ago, row.uptime_s, now) == row.proves);
}
