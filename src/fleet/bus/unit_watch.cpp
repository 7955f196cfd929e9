#include "blactl/fleet/bus/unit_watch.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::fleet {
namespace {

/// Uptime counts whole seconds and its message may be late: two starts closer than this are one.
constexpr Duration start_tolerance = std::chrono::milliseconds(1500);

/// The delay of a response whose request was not heard, and the tolerance for its start.
constexpr Duration usual_delay = std::chrono::seconds(1);
constexpr Duration answer_tolerance = std::chrono::seconds(2);

constexpr Duration uptime_step = std::chrono::seconds(1);

/// A frame is sent again as soon as the bus is free. Two servos that were switched on together may
/// number theirs alike, but not for long at the same moment.
constexpr Duration repetition_time = std::chrono::milliseconds(2);

dronecan::TransferId transfer_id(const can::Frame& frame) {
  return frame.size > 0 ? frame.data[frame.size - 1U] % dronecan::transfer_id_modulus : 0;
}

} // namespace

/// A servo alone on the bus gets no acknowledgement: when another node joins, its waiting frames
/// come all at once, and some of them may be lost. But one unit numbers its transfers upwards; if
/// the numbers of two units mix, every way there leads forward and the way back backward, or the
/// other way round.
void MessageRate::count(const can::Frame& frame, Time at, unsigned most_lost) {
  const bool is_repeated = frame == last_ && at - last_at_ < repetition_time;
  const unsigned next = transfer_id(last_) + 1U;
  last_ = frame;
  last_at_ = at;
  if (is_repeated) {
    return;
  }
  if (!window_start_ || at - *window_start_ > window_) {
    window_start_ = at;
    count_ = leaps_ = 0;
  }
  leaps_ += (transfer_id(frame) - next) % dronecan::transfer_id_modulus > most_lost ? 1U : 0U;
  ++count_;
  if (count_ > most_ && leaps_ > 1 && leaps_ * 8 > count_) {
    of_two_at_ = at;
  }
}

void UnitWatch::begin_anew() {
  const bool was_timed = is_timed_;
  *this = {};
  is_timed_ = was_timed;
}

void UnitWatch::count_actuator_status(const can::Frame& frame, Time at) {
  if (is_timed_) {
    actuator_statuses_.count(frame, at, dronecan::transfer_id_modulus / 2 - 1);
  }
}

void UnitWatch::count_node_status(const can::Frame& frame, std::uint32_t uptime_s, Time at) {
  const std::uint32_t before = std::exchange(counted_uptime_s_, uptime_s);
  if (uptime_s < before) {
    node_statuses_.begin_anew();
  }
  if (is_timed_) {
    // in one second of its uptime it sends one: nothing can be lost between two of them
    node_statuses_.count(frame, at,
                         uptime_s == before ? 0U : unsigned{dronecan::transfer_id_modulus});
    if (const auto header = dronecan::decode_id(frame.id)) {
      compare_priority(header->priority, at - std::chrono::seconds(uptime_s), at);
    }
  }
}

/// A unit sends NodeStatus with one priority (unproven). Another one may be of a unit that was put
/// in its place, or of its next program; but not if the first goes on after it, in the same run.
void UnitWatch::compare_priority(dronecan::Priority priority, Time start, Time at) {
  const auto [run, is_first] = run_starts_.try_emplace(priority, start);
  const bool has_changed = std::exchange(last_priority_, priority) != priority;
  if (has_changed && !is_first && std::chrono::abs(run->second - start) < start_tolerance) {
    two_priorities_at_ = at;
  }
  run->second = start;
}

/// Every uptime gives the start of its unit. A new start is a restart; a return to the old one
/// means that two units send under one ID. A unit that restarts at once shows by its uptime alone,
/// which never goes back.
///
/// A message delayed by a full bus makes a start look later. The unit then returns to its old start
/// and its uptime has never gone back, as it does each time a younger unit follows an older.
UnitWatch::Start UnitWatch::hear_uptime(std::uint32_t uptime_s, Time at) {
  const Time start = at - std::chrono::seconds(uptime_s);
  const std::uint32_t before = std::exchange(last_uptime_s_, uptime_s);
  if (!is_timed_) {
    const bool is_first = !starts_[last_start_];
    starts_[last_start_] = start;
    return !is_first && uptime_s < before ? Start::anew : Start::known;
  }
  may_be_late_ = may_be_late_ && uptime_s >= before;
  // a servo that restarts right after its start has two that are close to each other
  const auto distance = [&](const std::optional<Time>& known) {
    return known ? std::chrono::abs(*known - start) : Duration::max();
  };
  const auto it = std::ranges::min_element(starts_, {}, distance);
  if (distance(*it) < start_tolerance) {
    const auto index = static_cast<std::size_t>(it - starts_.begin());
    *it = uptime_s == before ? std::min(**it, start) : start; // clocks drift, but none stands still
    if (index != std::exchange(last_start_, index)) {
      starts_[1 - index] = may_be_late_ ? std::nullopt : starts_[1 - index];
      return std::exchange(may_be_late_, false) ? Start::known : Start::twin;
    }
    return uptime_s < before ? Start::anew : Start::known;
  }
  const bool is_first = !starts_[last_start_];
  may_be_late_ = !is_first && uptime_s >= before && start > *starts_[last_start_];
  last_start_ = is_first ? last_start_ : 1 - last_start_;
  starts_[last_start_] = start;
  return is_first ? Start::known : Start::anew;
}

UnitWatch::Start UnitWatch::hear_repetition(dronecan::TransferId transfer_id,
                                            std::uint32_t uptime_s, Time at) {
  const bool is_repeated = std::exchange(last_status_id_, transfer_id) == transfer_id;
  return is_repeated ? hear_uptime(uptime_s, at) : Start::known;
}

/// The longest possible one.
Duration UnitWatch::delay(const dronecan::Transfer& response) const {
  const Request& request = requests_[response.transfer_id];
  const bool was_heard =
      request.client.is_unicast() && request.client == response.header.destination;
  return was_heard ? response.at - request.at : usual_delay;
}

UnitWatch::Start UnitWatch::hear_answer(std::uint32_t uptime_s,
                                        const dronecan::Transfer& response) {
  if (!is_timed_) { // it may have been delayed
    return Start::known;
  }
  const auto known = started();
  const Time latest = response.at - std::chrono::seconds(uptime_s);
  const Time earliest = latest - delay(response) - uptime_step;
  if (!known || earliest > *known) {
    return hear_uptime(uptime_s, response.at);
  }
  if (*known - latest > answer_tolerance) {
    return Start::twin;
  }
  starts_[last_start_] =
      std::min(*known, latest); // the nearer to its start, the sooner another shows
  return Start::known;
}

} // namespace blactl::fleet
