#include "blactl/fleet/bus/servo.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::fleet {

bool has_run_since(Time since, std::uint32_t uptime_s, Time now) {
  constexpr std::uint32_t old_enough_s = 2; // near 0, whole seconds show no restart
  constexpr double clock_error = 0.02;
  const std::chrono::duration<double> elapsed = now - since;
  return uptime_s >= old_enough_s && uptime_s * (1 - clock_error) > elapsed.count();
}

std::string id_list(std::span<const dronecan::NodeId> ids) {
  std::string out;
  for (const dronecan::NodeId id : ids) {
    out += (out.empty() ? "" : ", ") + std::to_string(id.value());
  }
  return out;
}

namespace {

using namespace std::chrono_literals;

/// The least absence of a servo after a restart. unproven: the specification does not give its
/// duration.
constexpr Duration least_absence = 20ms;

std::int64_t whole_seconds(Duration duration) {
  return std::chrono::floor<std::chrono::seconds>(duration).count();
}

} // namespace

UptimeCheck::Verdict UptimeCheck::judge(std::uint32_t uptime_s, Time asked, Time told) {
  // a process with little CPU time asks late, too
  delay_ = told - std::min(asked, asking_at_.value_or(asked));
  const std::chrono::seconds uptime(uptime_s);
  earliest_start_ = asked - uptime - 1s; // it counts whole seconds
  if (uptime_s < whole_seconds(asked - since_)) {
    return Verdict::restarted;
  }
  if (has_run_since(since_, uptime_s, told)) {
    return Verdict::ran_on;
  }
  const bool is_older = uptime + least_absence >= told - since_;
  return uptime_s > 0 && is_older ? Verdict::ran_on : Verdict::unclear;
}

/// In a unit that has not restarted, the seconds change earlier by the time for which it ran before
/// `since_`. That lies between the delay of its response and the bound from the last uptime: the
/// middle halves it.
Time UptimeCheck::next(Time now) {
  const Duration least = std::max(Duration::zero(), delay_ - least_absence / 2);
  const Duration most = std::min<Duration>(since_ - std::min(since_, earliest_start_), 1s);
  const Duration lead = least > 0s && least < most ? (least + most) / 2 : Duration::zero();
  return asking_at_.emplace(since_ + std::chrono::seconds(whole_seconds(now + lead - since_) + 1) -
                            lead);
}

} // namespace blactl::fleet
