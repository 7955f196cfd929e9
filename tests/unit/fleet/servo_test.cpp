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

TEST_CASE("an uptime asked a whole number of seconds later tells whether a unit started anew") {
  using Verdict = UptimeCheck::Verdict;

  struct Row {
    Duration asked, told;
    std::uint32_t uptime_s;
    Verdict verdict;
  };

  const auto row = GENERATE(values<Row>({
      {1s, 1s, 1, Verdict::ran_on}, // also if it had just started
      {1s, 1s, 2, Verdict::ran_on},
      {1s, 1s, 0, Verdict::restarted},
      {1s, 1020ms, 1, Verdict::ran_on},
      {1s, 1021ms, 1, Verdict::unclear}, // it may have started 21 ms after
      {1s, 1021ms, 0, Verdict::restarted},
      {990ms, 1010ms, 0, Verdict::unclear}, // it may have been told before the second was full
      {990ms, 1010ms, 1, Verdict::ran_on},
      {5ms, 10ms, 0, Verdict::unclear},
      {500ms, 510ms, 1, Verdict::ran_on}, // it is older than that
      {1999ms, 1999ms, 1, Verdict::unclear},
      {2s, 2s, 1, Verdict::restarted},
      {2s, 2s, 2, Verdict::ran_on},
      {3s, 3001ms, 3, Verdict::ran_on},
      {3s, 3001ms, 2, Verdict::restarted},
      {1s, 1s, 0xFFFF'FFFF, Verdict::ran_on},
  }));
  const Time since{1'000'000s};
  CAPTURE(row.uptime_s, row.asked.count(), row.told.count());
  CHECK(UptimeCheck(since).judge(row.uptime_s, since + row.asked, since + row.told) == row.verdict);
}

TEST_CASE("an uptime is asked for so that it is told at the next whole second") {
  const Time since{1'000'000s};
  const UptimeCheck check(since);
  CHECK(check.next(since, 1ms) == since + 1s);
  CHECK(check.next(since + 999ms, 1ms) == since + 1s);
  CHECK(check.next(since + 1s, 1ms) == since + 2s);
  CHECK(check.next(since + 2500ms, 10ms) == since + 3s);
  CHECK(check.next(since + 30ms, 30ms) == since + 980ms);
  CHECK(check.next(since + 985ms, 30ms) == since + 1980ms);
}
