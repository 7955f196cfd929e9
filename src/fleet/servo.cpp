#include "blactl/fleet/servo.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::fleet {

bool has_run_since(Time since, std::uint32_t uptime_s, Time now) {
  constexpr std::uint32_t old_enough_s = 2; // near 0 whole seconds show no restart
  constexpr double clock_error = 0.02;
  const std::chrono::duration<double> elapsed = now - since;
  return uptime_s >= old_enough_s && uptime_s * (1 - clock_error) > elapsed.count();
}

namespace {

using namespace std::chrono_literals;

/// A servo is not back so soon after a restart. unproven: the specification does not say how long
/// it takes.
constexpr Duration least_absence = 20ms;

std::int64_t whole_seconds(Duration duration) {
  return std::chrono::floor<std::chrono::seconds>(duration).count();
}

} // namespace

Time UptimeCheck::next(Time now, Duration round_trip) const {
  // The answer, too, must be there in time.
  const Duration lead = std::max(Duration::zero(), round_trip - least_absence / 2);
  return since_ + std::chrono::seconds(whole_seconds(now + lead - since_) + 1) - lead;
}

UptimeCheck::Verdict UptimeCheck::judge(std::uint32_t uptime_s, Time asked, Time told) const {
  if (std::int64_t{uptime_s} < whole_seconds(asked - since_)) {
    return Verdict::restarted;
  }
  const bool is_older = std::chrono::seconds(uptime_s) + least_absence >= told - since_;
  return uptime_s > 0 && is_older ? Verdict::ran_on : Verdict::unclear;
}

} // namespace blactl::fleet
