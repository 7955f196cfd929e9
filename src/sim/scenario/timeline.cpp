#include "blactl/sim/scenario/timeline.hpp"

#include <algorithm>
#include <utility>

namespace blactl::sim {

std::optional<ClientLink> parse_client_link(std::string_view word) {
  if (word == "joined") {
    return ClientLink::joined;
  }
  if (word == "cut") {
    return ClientLink::cut;
  }
  return word == "bus_off" ? std::optional(ClientLink::bus_off) : std::nullopt;
}

Timeline::Timeline(std::vector<TimedEvent> events, Time power_on)
    : events_(std::move(events)), power_on_(power_on) {
  std::ranges::stable_sort(events_, {}, &TimedEvent::at);
}

Time Timeline::next() const {
  return taken_ < events_.size() ? power_on_ + events_[taken_].at : never;
}

const TimedEvent* Timeline::take(Time now) {
  return next() <= now ? &events_[taken_++] : nullptr;
}

} // namespace blactl::sim
