#pragma once
// The two clocks of blactl: the bus clock, which only the loop reads, and wall time for records.

#include <chrono>

namespace blactl {

/// All times are in microseconds, one bit time at 1 Mbit/s.
using Duration = std::chrono::microseconds;

/// The clock of one bus: monotonic; CLOCK_MONOTONIC on real interfaces, the simulator's time on a
/// simulated bus. It has no now(): only can::Loop knows the time.
struct BusClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<BusClock>;
  static constexpr bool is_steady = true;
};

using Time = BusClock::time_point;

/// "Never": a deadline that is not reached.
inline constexpr Time never = Time::max();

/// UTC, for records and logs.
using WallTime = std::chrono::sys_time<Duration>;

} // namespace blactl
