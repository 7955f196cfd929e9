#include "blactl/fleet/live/poll_job.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Step;

namespace {

/// After this number of consecutive requests without a response a servo is not asked until it is
/// heard.
constexpr int most_unanswered = 3;

/// A failed identification is repeated after this.
constexpr Duration identification_pause = std::chrono::seconds(2);

} // namespace

PollJob::PollJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
                 Identification::Options options, const PollPlan& plan, Further further)
    : roster_(roster), id_(id), profiles_(profiles), options_(options), plan_(plan),
      further_(std::move(further)) {}

Step PollJob::next(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::cancelled) {
    return std::nullopt;
  }
  if (roster_.is_doubled(id_)) { // a response could be either unit's
    return wait_for_sign(outcome.at);
  }
  switch (at_) {
  case At::identify: return identify(outcome);
  case At::unit:
  case At::read: return take_answer(outcome);
  case At::begin:
  case At::rest: break;
  }
  return begin_round(outcome.at);
}

Step PollJob::identify(const Outcome& outcome) {
  at_ = At::identify;
  if (Step step = identification_->next(outcome); !step.is_end()) {
    return step;
  }
  if (!identification_->done()) {
    const bool is_other = identification_->error()->code == Code::not_found;
    return is_other ? end() : rest(outcome.at + identification_pause);
  }
  if (!identification_->servo().is_servo) {
    return end();
  }
  servo_ = identification_->servo();
  return begin_round(outcome.at);
}

bool PollJob::has_restarted() const {
  return servo_ && servo_->boot != roster_.member(id_).boots;
}

/// Whether another unit may be here: it is asked for its unique ID before anything else.
bool PollJob::is_in_doubt() const {
  return servo_ && roster_.member(id_).may_be_another();
}

Step PollJob::ask_unit() {
  at_ = At::unit;
  Patience once = options_.patience;
  once.retries = 0;
  return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), once);
}

Step PollJob::begin_round(Time now) {
  if (!servo_ || has_restarted()) {
    servo_.reset();
    identification_.emplace(roster_, id_, profiles_, options_);
    return identify({Outcome::Kind::start, {}, now});
  }
  if (is_in_doubt()) {
    left_.clear();
    return ask_unit();
  }
  round_began_ = now;
  const auto further = further_();
  polls_ = further.has_value();
  if (!further) {
    return wait_for_restart();
  }
  std::vector<bla::Address> wanted = plan_.often;
  wanted.insert(wanted.end(), further->often.begin(), further->often.end());
  std::vector<bla::Address> seldom = plan_.seldom;
  seldom.insert(seldom.end(), further->seldom.begin(), further->seldom.end());
  if (!seldom.empty()) {
    wanted.push_back(seldom[turn_++ % seldom.size()]);
  }
  left_ = servo_->identity.registers(wanted);
  std::ranges::reverse(left_);
  return read_next(now);
}

Step PollJob::take_answer(const Outcome& outcome) {
  unanswered_ = outcome.answered() ? 0 : unanswered_ + 1;
  return unanswered_ == most_unanswered ? wait_for_sign(outcome.at) : read_next(outcome.at);
}

Step PollJob::read_next(Time now) {
  if (is_in_doubt()) {
    return ask_unit();
  }
  if (left_.empty() || has_restarted()) {
    return rest(std::max(now, round_began_ + plan_.round));
  }
  at_ = At::read;
  const bla::Address address = left_.back()->address;
  left_.pop_back();
  Patience once = options_.patience;
  once.retries = 0; // the next round asks again
  return read_register(id_, address, once);
}

Step PollJob::rest(Time until) {
  at_ = At::rest;
  return dronecan::Pause{.until = until,
                         .ready = [this] { return has_restarted() || is_in_doubt(); }};
}

/// Waits until something is heard from it.
Step PollJob::wait_for_sign(Time now) {
  unanswered_ = 0;
  at_ = At::rest;
  return dronecan::Pause{.until = now + offline_time, .ready = [this, now] {
                           return roster_.member(id_).last_heard > now && !roster_.is_doubled(id_);
                         }};
}

Step PollJob::wait_for_restart() {
  at_ = At::rest;
  return dronecan::Pause{.ready = [this] { return has_restarted() || is_in_doubt(); }};
}

Step PollJob::end() {
  polls_ = false;
  return std::nullopt;
}

} // namespace blactl::fleet
