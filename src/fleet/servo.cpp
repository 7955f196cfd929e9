#include "blactl/fleet/servo.hpp"

#include <chrono>

namespace blactl::fleet {

bool has_run_since(Time since, std::uint32_t uptime_s, Time now) {
  constexpr std::uint32_t old_enough_s = 2; // near 0 whole seconds show no restart
  constexpr double clock_error = 0.02;
  const std::chrono::duration<double> elapsed = now - since;
  return uptime_s >= old_enough_s && uptime_s * (1 - clock_error) > elapsed.count();
}

} // namespace blactl::fleet
