#include "blactl/fleet/read_job.hpp"

#include "blactl/fleet/guard.hpp"
#include "blactl/fleet/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Step;

namespace {

/// Registers in a row that do not answer, before it is asked whether the servo is there at all.
constexpr int most_silent = 2;

/// A servo that restarts more often while it is read is not read to an end.
constexpr int most_passes = 4;

/// Uptimes that may come too late to tell anything.
constexpr int most_uptimes = 4;

} // namespace

ReadJob::ReadJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
                 Identification::Options options, Choice choice, Proof proof, More more)
    : roster_(roster), id_(id), patience_(options.patience),
      identification_(roster, id, profiles, options), choice_(std::move(choice)),
      more_(std::move(more)), proof_(proof) {
  snapshot_.servo.id = id;
}

Step ReadJob::next(const Outcome& outcome) {
  switch (at_) {
  case At::identify:
    if (auto question = identification_.next(outcome)) {
      return question;
    }
    return begin(outcome.at);
  case At::read: return take_reading(outcome);
  case At::presence: return judge_presence(outcome);
  case At::proof: return judge_proof(outcome);
  case At::uptime: return ask_unit(At::proof);
  case At::settle: break;
  }
  if (roster_.is_doubled(id_)) {
    return give_up(doubled(roster_, id_));
  }
  return std::nullopt;
}

Step ReadJob::begin(Time now) {
  if (identification_.error()) {
    snapshot_.error = roster_.is_doubled(id_) ? doubled(roster_, id_) : identification_.error();
    return std::nullopt;
  }
  snapshot_.servo = identification_.servo();
  const std::uint8_t id = id_.value();
  if (!snapshot_.servo.is_servo) {
    snapshot_.error =
        Error{Code::not_found, say<texts::not_a_servo>(id, printable(snapshot_.servo.name)),
              say<texts::node_not_found_hint>(), id};
    return std::nullopt;
  }
  auto wanted = choice_(snapshot_.servo);
  if (!wanted) {
    snapshot_.error = Error{wanted.error().code, say<texts::about_node>(id, wanted.error().message),
                            wanted.error().hint, id};
    return std::nullopt;
  }
  wanted_ = std::move(*wanted);
  snapshot_.readings.reserve(wanted_.size());
  return wanted_.empty() ? settle(now) : read_next();
}

Step ReadJob::take_reading(const Outcome& outcome) {
  const bla::Parameter& parameter = *wanted_[snapshot_.readings.size()];
  auto raw = register_value(outcome, id_, parameter.address);
  if (raw) {
    *raw = parameter.width.narrow(*raw);
  }
  silent_ = outcome.kind == Outcome::Kind::timed_out ? silent_ + 1 : 0;
  snapshot_.readings.push_back({&parameter, std::move(raw)});
  if (outcome.kind == Outcome::Kind::cancelled) {
    const std::uint8_t id = id_.value();
    return give_up({Code::interrupted, say<texts::not_read_completely>(id), {}, id});
  }
  if (roster_.is_doubled(id_) && proof_ != Proof::none) {
    return give_up(doubled(roster_, id_));
  }
  if (silent_ == most_silent) {
    return ask_unit(At::presence);
  }
  return read_next();
}

bool ReadJob::has_next() {
  if (snapshot_.readings.size() == wanted_.size() && more_) {
    for (const bla::Parameter* parameter : more_(snapshot_)) {
      if (std::ranges::find(wanted_, parameter) == wanted_.end()) {
        wanted_.push_back(parameter);
      }
    }
  }
  return snapshot_.readings.size() < wanted_.size();
}

Step ReadJob::read_next() {
  if (!has_next()) {
    return proof_ == Proof::none ? Step(std::nullopt) : ask_unit(At::proof);
  }
  at_ = At::read;
  return read_register(id_, wanted_[snapshot_.readings.size()]->address, patience_);
}

Step ReadJob::ask_unit(At at) {
  at_ = at;
  return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
}

/// Single registers may be silent; a servo that is gone is one error, not one a register.
Step ReadJob::judge_presence(const Outcome& outcome) {
  const std::uint8_t id = id_.value();
  if (outcome.kind == Outcome::Kind::timed_out) {
    return give_up({Code::timeout, say<texts::node_gone>(id), say<texts::no_answer_hint>(), id});
  }
  if (!outcome.answered()) {
    return give_up(no_answer(outcome, id_, "GetNodeInfo"));
  }
  silent_ = 0;
  return read_next();
}

Step ReadJob::judge_proof(const Outcome& outcome) {
  const std::uint8_t id = id_.value();
  if (!outcome.answered()) {
    return judge_presence(outcome);
  }
  Servo& servo = snapshot_.servo;
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (roster_.is_doubled(id_)) {
    return give_up(doubled(roster_, id_));
  }
  if (!info || info->unique_id != servo.unique_id) {
    return give_up(
        {Code::state, say<texts::restarted_meanwhile>(id), say<texts::run_again_hint>(), id});
  }
  const bool runs_on = !has_another_boot();
  if (runs_on && has_run_since(must_run_since(), info->status.uptime_s, outcome.at)) {
    return settle(outcome.at);
  }
  if (runs_on && proof_ == Proof::run && !snapshot_.has_restarted) {
    return judge_uptime(info->status.uptime_s, outcome.at);
  }
  return judge_passes(runs_on, outcome.at);
}

/// An uptime near 0, or one that is not older than the first question, is asked for again when it
/// tells something.
Step ReadJob::judge_uptime(std::uint32_t uptime_s, Time now) {
  using Verdict = UptimeCheck::Verdict;
  const UptimeCheck check(must_run_since());
  const Verdict verdict = check.judge(uptime_s, now);
  if (verdict == Verdict::ran_on && uptimes_ > 0) {
    return settle(now);
  }
  if (verdict == Verdict::restarted) {
    return judge_passes(false, now);
  }
  if (uptimes_ == most_uptimes) {
    const std::uint8_t id = id_.value();
    return give_up(
        {Code::state, say<texts::answers_too_late>(id), say<texts::run_again_hint>(), id});
  }
  ++uptimes_;
  at_ = At::uptime;
  return dronecan::Pause{.until = check.next(now),
                         .ready = [this] { return roster_.is_doubled(id_) || has_another_boot(); }};
}

Step ReadJob::judge_passes(bool runs_on, Time now) {
  const bool agrees = passes_ == 1 || agrees_with_before();
  snapshot_.has_restarted = snapshot_.has_restarted || !runs_on || !agrees;
  if (runs_on && passes_ > 1 && agrees) {
    return settle(now);
  }
  if (passes_ == most_passes) {
    const std::uint8_t id = id_.value();
    return give_up(
        {Code::state, say<texts::restarts_while_read>(id), say<texts::restarts_again_hint>(), id});
  }
  return read_again(now);
}

/// The same servo, perhaps after a restart: everything once more.
Step ReadJob::read_again(Time now) {
  ++passes_;
  before_ = std::exchange(snapshot_.readings, {});
  Servo& servo = snapshot_.servo;
  servo.boot = roster_.member(id_).boots;
  servo.since = now;
  roster_.learn_run(servo);
  return read_next();
}

/// What RAM held when this session heard the servo first may be meant, however often it was
/// identified since.
Time ReadJob::must_run_since() const {
  return proof_ == Proof::run && !snapshot_.has_restarted ? roster_.member(id_).first_heard
                                                          : snapshot_.servo.since;
}

bool ReadJob::has_another_boot() const {
  return roster_.member(id_).boots != snapshot_.servo.boot;
}

/// Measured values may differ, those that are kept may not.
bool ReadJob::agrees_with_before() const {
  return std::ranges::equal(before_, snapshot_.readings,
                            [](const Reading& before, const Reading& now) {
                              const bool same = before.raw.has_value() == now.raw.has_value() &&
                                                (!now.raw || *before.raw == *now.raw);
                              return same || !now.parameter->saved;
                            });
}

Step ReadJob::settle(Time now) {
  if (proof_ == Proof::none) {
    return std::nullopt;
  }
  at_ = At::settle;
  return dronecan::Pause{.until = now + twin_time,
                         .ready = [this] { return roster_.is_doubled(id_); }};
}

/// What was read is not shown: it may be of two units, or of two times.
Step ReadJob::give_up(Error error) {
  snapshot_.error = std::move(error);
  snapshot_.readings.clear();
  return std::nullopt;
}

} // namespace blactl::fleet
