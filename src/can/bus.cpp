#include "blactl/can/bus.hpp"

#include <chrono>

namespace blactl::can {

Time Bus::now() const {
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

WallTime Bus::wall() const {
  return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
}

} // namespace blactl::can
