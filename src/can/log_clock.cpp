#include "blactl/can/log_clock.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::can {
namespace {

/// How far rising stamps of one log may be out of order: sockets are read in turn.
constexpr Duration most_disorder = std::chrono::milliseconds(10);

/// Whether this step is impossible for stamps that count from the first frame.
bool falls(WallTime last, WallTime at) {
  return at.time_since_epoch() < last.time_since_epoch() / 2 || last - at > most_disorder;
}

/// Adds without overflow, since the digits are foreign.
template <class Clock> Clock later(Clock time, Duration step) {
  constexpr Clock latest{Clock::max().time_since_epoch() / 2};
  return time + std::min(step, latest - time);
}

} // namespace

void LogClock::pass(const LogLine& line) {
  using Stamp = LogLine::Stamp;
  if (line.stamp == Stamp::none) {
    return;
  }
  const bool goes_on = line.stamp == stamp_;
  adds_up_ = goes_on && (adds_up_ || (line.stamp == Stamp::relative && falls(last_, line.at)));
  const Duration since = goes_on ? std::max(line.at - last_, Duration()) : Duration();
  const Duration step = adds_up_ ? line.at.time_since_epoch() : since;
  wall_ = adds_up_ ? later(wall_, step) : line.at;
  now_ = later(now_, step);
  stamp_ = line.stamp;
  last_ = line.at;
}

} // namespace blactl::can
