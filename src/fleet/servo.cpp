#include "blactl/fleet/servo.hpp"

#include <chrono>

namespace blactl::fleet {

bool has_run_since(Time since, std::uint32_t uptime_s, Time now) {
  constexpr std::uint32_t old_enough_s = 2; // near 0 whole seconds show no restart
  constexpr double clock_error = 0.02;
  const std::chrono::duration<double> elapsed = now - since;
  return uptime_s >= old_enough_s && uptime_s * (1 - clock_error) > elapsed.count();
}

namespace {

std::int64_t whole_seconds(Duration duration) {
  return std::chrono::floor<std::chrono::seconds>(duration).count();
}

} // namespace

Time UptimeCheck::next(Time now) const {
  return since_ + std::chrono::seconds(whole_seconds(now - since_) + 1);
}

UptimeCheck::Verdict UptimeCheck::judge(std::uint32_t uptime_s, Time now) const {
  // A servo is not back so soon after a restart.
  constexpr Duration most_delay = std::chrono::milliseconds(20);
  const Duration elapsed = now - since_;
  const std::int64_t seconds = whole_seconds(elapsed);
  if (std::int64_t{uptime_s} < seconds) {
    return Verdict::restarted;
  }
  return elapsed - std::chrono::seconds(seconds) <= most_delay ? Verdict::ran_on
                                                               : Verdict::too_late;
}

} // namespace blactl::fleet
