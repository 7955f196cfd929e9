#include "blactl/fleet/live/fault_watch.hpp"

#include <algorithm>

namespace blactl::fleet {

FaultWatch::FaultWatch(Session& session, const bla::Profiles& profiles,
                       std::span<const dronecan::NodeId> servos,
                       const Identification::Options& options, Duration interval)
    : session_(session), profiles_(profiles), options_(options), interval_(interval) {
  for (const dronecan::NodeId id : servos) {
    looks_.push_back({.id = id, .due = session.now()});
  }
}

FaultWatch::~FaultWatch() {
  for (const Look& look : looks_) {
    if (look.job) {
      session_.cancel(*look.job);
    }
  }
}

void FaultWatch::begin() {
  for (Look& look : looks_) {
    if (!look.job && look.due <= session_.now()) {
      look.job = std::make_unique<FaultJob>(session_, profiles_, look.id, options_);
      session_.start(*look.job);
    }
  }
}

bool FaultWatch::has_ended(const Look& look) const {
  return look.job && !session_.node().is_running(*look.job);
}

Time FaultWatch::next_due() const {
  Time next = never;
  for (const Look& look : looks_) {
    next = look.job ? next : std::min(next, look.due);
  }
  return next;
}

Result<std::vector<FaultState>> FaultWatch::next() {
  std::vector<FaultState> states;
  while (states.empty()) {
    session_.records().forget_doubled(session_.now() - doubt_time);
    begin();
    const auto lived = session_.live_until(next_due(), [this] {
      return std::ranges::any_of(looks_, [this](const Look& look) { return has_ended(look); });
    });
    if (!lived) {
      return std::unexpected(lived.error());
    }
    for (Look& look : looks_) {
      if (has_ended(look)) {
        states.push_back(look.job->state());
        look.job.reset();
        look.due = session_.now() + interval_;
      }
    }
  }
  return states;
}

} // namespace blactl::fleet
