#include "blactl/can/bus.hpp"

#include "can/texts.hpp"

#include <chrono>

namespace blactl::can {

Time Bus::now() const {
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

/// Reads both clocks at one moment: if the process was suspended in between, it reads them again,
/// otherwise a log would go back in time.
WallTime Bus::wall_at(Time at) const {
  constexpr Duration one_moment = std::chrono::microseconds(20);
  constexpr int most_tries = 10;
  for (int i = 1;; ++i) {
    const Time before = now();
    const WallTime read = wall();
    if (now() - before <= one_moment || i == most_tries) {
      return read - (before - at);
    }
  }
}

WallTime Bus::wall() const {
  return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
}

std::string Bus::bus_off_hint() const {
  return say<texts::bus_off_hint>();
}

} // namespace blactl::can
