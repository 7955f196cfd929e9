#include "blactl/fleet/live/fault_watch.hpp"

#include "blactl/fleet/bus/unreachable.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::fleet {
namespace {

/// A servo sends NodeStatus every second and actuator.Status ten times as often: when both are
/// missing for so long, it is silent.
constexpr Duration silence = std::chrono::seconds(2);

} // namespace

FaultWatch::FaultWatch(Session& session, const bla::Profiles& profiles,
                       std::span<const dronecan::NodeId> servos,
                       const Identification::Options& options, Duration interval)
    : session_(session), profiles_(profiles), options_(options), interval_(interval) {
  session.records().accept_exchanges();
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
    next = std::min({next, look.job ? never : look.due, silent_from(look)});
  }
  return next;
}

/// When it counts as silent if nothing more is heard; never: that was told, or it was never heard.
Time FaultWatch::silent_from(const Look& look) const {
  const Member* member = session_.roster().find(look.id);
  return session_.is_replay() || member == nullptr || member->last_heard == look.told_silent
             ? never
             : member->last_heard + silence;
}

void FaultWatch::tell_silent(std::vector<FaultState>& states) {
  for (Look& look : looks_) {
    if (silent_from(look) <= session_.now()) {
      const Member member = session_.roster().member(look.id);
      look.told_silent = member.last_heard;
      states.push_back({.snapshot = {.servo = member.servo()},
                        .faults = {},
                        .health = {},
                        .errors = {silent(session_.roster(), look.id)}});
    }
  }
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
    tell_silent(states);
  }
  return states;
}

} // namespace blactl::fleet
