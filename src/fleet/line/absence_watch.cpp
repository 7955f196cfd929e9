#include "fleet/line/absence_watch.hpp"

#include "fleet/line/presence.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::fleet {

namespace {

constexpr Duration absence_period = std::chrono::milliseconds(100);

} // namespace

AbsenceWatch::AbsenceWatch(Session& session, std::function<void(bool is_away)> hook)
    : session_(session), hook_(std::move(hook)), began_(session.now()),
      ticker_(session, absence_period, [this] { look(); }) {}

/// Who sends no actuator.Status, or has no node ID yet, is heard about once a second.
void AbsenceWatch::look() {
  Time last = began_;
  Duration patience = request_period;
  for (const auto& [prefix, asking] : session_.roster().requests()) {
    last = std::max(last, asking.last);
  }
  for (const auto& [id, member] : session_.roster().members()) {
    if (may_be_bla_servo(member) && member.last_heard > last) {
      last = member.last_heard;
      patience = member.sends_actuator_status() ? away_time : request_period;
    }
  }
  patience = is_restarting_ ? off_time : patience;
  const bool is_away = !session_.away() && session_.now() - last > patience;
  was_away_ = was_away_ || (is_away && !is_restarting_);
  if (std::exchange(is_away_, is_away) != is_away) {
    hook_(is_away);
  }
}

} // namespace blactl::fleet
