#include "blactl/can/bus.hpp"

#include "can/texts.hpp"

#include <chrono>

namespace blactl::can {

Time Bus::now() const {
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

WallTime Bus::wall() const {
  return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
}

std::string Bus::bus_off_hint() const {
  return say<texts::bus_off_hint>();
}

} // namespace blactl::can
