#include "blactl/fleet/bus/servo.hpp"

#include "catch.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>
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
  UptimeCheck check(since);
  CHECK(check.judge(row.uptime_s, since + row.asked, since + row.told) == row.verdict);
}

TEST_CASE("an uptime is asked for so that it is told at the next whole second") {
  const Time since{1'000'000s};
  const auto next = [&](Duration asked, Duration told) {
    UptimeCheck check(since);
    REQUIRE(check.judge(0, since + asked, since + told) == UptimeCheck::Verdict::unclear);
    return check.next(since + told) - since;
  };
  CHECK(next(0ms, 1ms) == 1s);
  CHECK(next(988ms, 998ms) == 1s);
  CHECK(next(990ms, 1000ms) == 2s);
  CHECK(next(0ms, 30ms) == 490ms); // between 20 ms for the answer and 1 s
  CHECK(next(600ms, 630ms) == 790ms);
  CHECK(next(970ms, 990ms) == 1980ms); // it started 20 ms before at the earliest
}

TEST_CASE("where answers take their time, uptimes still tell who ran on, and nobody wrongly") {
  using Verdict = UptimeCheck::Verdict;
  // When the unit started, against `since`; a restart takes 20 ms.
  const Duration start =
      GENERATE(-1900ms, -999ms, -700ms, -400ms, -200ms, 20ms, 60ms, 400ms, 990ms);
  const unsigned seed = GENERATE(range(1U, 200U));
  CAPTURE(start.count(), seed);

  std::minstd_rand random(seed);
  const auto up_to = [&](Duration most) {
    return Duration(std::uniform_int_distribution<Duration::rep>(0, most.count())(random));
  };
  const Time since{1'000'000s};
  UptimeCheck check(since);
  Time asked = since + std::max<Duration>(start, 0ms) + up_to(900ms);
  Verdict verdict = Verdict::unclear;
  for (int uptimes = 0; uptimes < 8 && verdict == Verdict::unclear; ++uptimes) {
    asked += up_to(20ms); // this process sleeps longer than it wishes to
    const Time sampled = asked + up_to(60ms);
    const Time told = sampled + up_to(60ms);
    const auto uptime = std::chrono::floor<std::chrono::seconds>(sampled - since - start);
    verdict = check.judge(static_cast<std::uint32_t>(uptime.count()), asked, told);
    asked = check.next(told);
    REQUIRE(asked > told);
  }
  CHECK(verdict != (start > 0s ? Verdict::ran_on : Verdict::restarted));
  CHECK((start > 0s || verdict == Verdict::ran_on));
}
