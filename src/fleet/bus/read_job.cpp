#include "blactl/fleet/bus/read_job.hpp"

#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include <algorithm>
#include <list>
#include <map>
#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Step;

namespace {

/// The number of consecutive registers without a response before the presence of the servo is
/// checked.
constexpr int most_silent = 2;

/// A servo that restarts more often while it is read is given up.
constexpr int most_passes = 4;

/// Where requests have to be repeated more often, frames get lost.
constexpr int most_repeats = 4;

constexpr bla::Width id_width{.bits = 8, .is_signed = false};

/// Whoever is to prove that he ran on must be old enough for that.
Identification::Options settled(Identification::Options options, ReadJob::Proof proof) {
  options.settled = proof == ReadJob::Proof::moment || proof == ReadJob::Proof::run;
  return options;
}

} // namespace

ReadJob::ReadJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
                 Identification::Options options, Choice choice, Proof proof, More more)
    : roster_(roster), id_(id), patience_(options.patience),
      identification_(roster, id, profiles, settled(options, proof)), choice_(std::move(choice)),
      more_(std::move(more)), proof_(proof) {
  snapshot_.servo.id = id;
}

Step ReadJob::next(const Outcome& outcome) {
  switch (at_) {
  case At::identify:
    if (Step step = identification_.next(outcome); !step.is_end()) {
      return step;
    }
    return begin(outcome.at);
  case At::read: return take_reading(outcome);
  case At::presence: return judge_presence(outcome);
  case At::proof: return judge_proof(outcome);
  case At::servo_id:
  case At::static_node_id: return take_id(outcome);
  case At::anew: return begin_anew(outcome.at);
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
    snapshot_.error = not_a_servo(id_, snapshot_.servo.name);
    return std::nullopt;
  }
  if (roster_.is_exchanged(snapshot_.servo)) {
    return give_up({Code::state, say<texts::another_servo>(id), say<texts::run_again_hint>(), id});
  }
  auto wanted = choice_(snapshot_.servo);
  if (!wanted) {
    snapshot_.error = Error{wanted.error().code, say<texts::about_node>(id, wanted.error().message),
                            wanted.error().hint, id};
    return std::nullopt;
  }
  wanted_ = std::move(*wanted);
  snapshot_.readings.reserve(wanted_.size());
  pass_began_ = now;
  return read_next(now);
}

Step ReadJob::take_reading(const Outcome& outcome) {
  const bla::Parameter& parameter = *wanted_[snapshot_.readings.size()];
  auto raw = register_value(outcome, id_, parameter.address, parameter.width);
  silent_ = outcome.kind == Outcome::Kind::timed_out ? silent_ + 1 : 0;
  snapshot_.readings.push_back({&parameter, std::move(raw)});
  if (outcome.kind == Outcome::Kind::cancelled) {
    const std::uint8_t id = id_.value();
    return give_up({Code::interrupted, say<texts::not_read_completely>(id), {}, id});
  }
  if (roster_.is_doubled(id_) && proof_ != Proof::none) {
    return give_up(doubled(roster_, id_));
  }
  if (may_have_restarted(outcome)) {
    return read_again_after_silence(outcome.at);
  }
  asked_last_ = outcome.at;
  if (silent_ == most_silent) {
    at_ = At::presence;
    return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
  }
  return read_next(outcome.at);
}

/// A request that had to be repeated may have come while the servo started, and its uptime cannot
/// tell yet: what was read before is of another run then.
bool ReadJob::may_have_restarted(const Outcome& outcome) {
  const bool was_repeated = outcome.asked - asked_last_ >= patience_.timeout;
  was_silent_ = was_silent_ || !outcome.answered() || was_repeated;
  return outcome.answered() && is_in_doubt();
}

bool ReadJob::is_in_doubt() const {
  return proof_ == Proof::unit && was_silent_ && repeats_ < most_repeats;
}

/// As Identification::may_be_of_two(): another one may have been here, and gone again.
bool ReadJob::may_be_of_two() const {
  const Member member = roster_.member(id_);
  return member.sends_actuator_status() && member.back_at > snapshot_.servo.since &&
         repeats_ < most_repeats;
}

/// It is no proof of a restart.
Step ReadJob::read_again_after_silence(Time now) {
  was_silent_ = false;
  ++repeats_;
  --passes_;
  return read_again(now);
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

Step ReadJob::read_next(Time now) {
  if (!has_next()) {
    return proof_ == Proof::none ? Step(std::nullopt) : prove(now);
  }
  if (at_ != At::read) {
    asked_last_ = now;
  }
  at_ = At::read;
  return read_register(id_, wanted_[snapshot_.readings.size()]->address, patience_);
}

/// Single registers may be silent; a servo that is gone is one error, not one per register.
Step ReadJob::judge_presence(const Outcome& outcome) {
  if (!outcome.answered()) {
    return give_up(told_by(no_answer(outcome, id_, "GetNodeInfo")));
  }
  silent_ = 0;
  return read_next(outcome.at);
}

/// A servo that does not respond any more is gone, unless a second one disturbs its responses.
Error ReadJob::told_by(const Error& error) const {
  const std::uint8_t id = id_.value();
  if (error.code == Code::timeout && roster_.is_doubled(id_)) {
    return doubled(roster_, id_);
  }
  return error.code == Code::timeout
             ? Error{Code::timeout, say<texts::node_gone>(id), say<texts::no_answer_hint>(), id}
             : error;
}

Step ReadJob::prove(Time now) {
  at_ = At::proof;
  run_proof_.emplace(roster_, snapshot_.servo, must_run_since(), patience_);
  return run_proof_->next({Outcome::Kind::start, {}, now});
}

Step ReadJob::judge_proof(const Outcome& outcome) {
  if (Step step = run_proof_->next(outcome); !step.is_end()) {
    return step;
  }
  const std::uint8_t id = id_.value();
  switch (run_proof_->verdict()) {
  case RunProof::Verdict::ran_on:
    return is_in_doubt() || may_be_of_two() ? read_again_after_silence(outcome.at)
                                            : judge_writers(outcome.at);
  case RunProof::Verdict::failed: return give_up(told_by(*run_proof_->error()));
  case RunProof::Verdict::too_late:
    if (passes_ == most_passes || is_about_earlier_run()) {
      return give_up(
          {Code::state, say<texts::answers_too_late>(id), say<texts::run_again_hint>(), id});
    }
    return read_again(outcome.at); // from now on it is older
  case RunProof::Verdict::restarted: break;
  }
  return judge_restart(outcome.at);
}

Step ReadJob::judge_restart(Time now) {
  const std::uint8_t id = id_.value();
  snapshot_.has_restarted = snapshot_.servo.is_young = true;
  if (passes_ == most_passes) {
    return give_up(
        {Code::state, say<texts::restarts_while_read>(id), say<texts::restarts_again_hint>(), id});
  }
  return read_again(now);
}

/// Readings with a change by another node in between are not of one moment.
Step ReadJob::judge_writers(Time now) {
  const auto writer = this->writer();
  if (!writer) {
    return std::nullopt;
  }
  if (passes_ == most_passes) {
    const std::uint8_t id = id_.value();
    return give_up({Code::state, say<texts::written_while_read>(id, writer->value()),
                    say<texts::other_writer_hint>(), id});
  }
  return read_again(now);
}

/// It is the same servo: reads everything again, its IDs first, which a restart may have changed.
Step ReadJob::read_again(Time now) {
  ++passes_;
  pass_began_ = now;
  snapshot_.readings.clear();
  Servo& servo = snapshot_.servo;
  servo.boot = roster_.member(id_).boots;
  servo.since = now;
  return read_id(At::servo_id);
}

Step ReadJob::read_id(At which) {
  at_ = which;
  return read_register(
      id_, which == At::servo_id ? bla::address::servo_id : bla::address::static_node_id,
      patience_);
}

Step ReadJob::take_id(const Outcome& outcome) {
  Servo& servo = snapshot_.servo;
  const bool is_first = at_ == At::servo_id;
  const auto raw = register_value(
      outcome, id_, is_first ? bla::address::servo_id : bla::address::static_node_id, id_width);
  (is_first ? servo.servo_id : servo.static_node_id) = raw ? std::optional(*raw) : std::nullopt;
  if (is_first && servo.static_node_id) {
    return read_id(At::static_node_id);
  }
  roster_.learn_run(servo);
  return read_next(outcome.at);
}

/// The earliest contents of RAM in this session may matter, however often the servo was identified
/// since.
bool ReadJob::is_about_earlier_run() const {
  return proof_ == Proof::run && !snapshot_.has_restarted;
}

std::optional<Time> ReadJob::must_run_since() const {
  if (proof_ == Proof::unit) {
    return std::nullopt;
  }
  return is_about_earlier_run() ? roster_.member(id_).first_heard : snapshot_.servo.since;
}

/// Readings are dropped: they may be of two units, or of two times.
Step ReadJob::give_up(Error error) {
  snapshot_.error = std::move(error);
  snapshot_.readings.clear();
  return std::nullopt;
}

/// It may have been read long before other servos, which are slower.
bool ReadJob::is_outdated() const {
  return !snapshot_.error && proof_ != Proof::none && (has_restarted_since() || writer());
}

/// Another node that changed one of the values since their reading began.
std::optional<dronecan::NodeId> ReadJob::writer() const {
  for (const bla::Parameter* parameter : wanted_) {
    if (const auto by = roster_.writer_to(id_, pass_began_, parameter->address)) {
      return by;
    }
  }
  return std::nullopt;
}

bool ReadJob::has_restarted_since() const {
  return roster_.member(id_).boots != snapshot_.servo.boot;
}

Step ReadJob::begin_anew(Time now) {
  return has_restarted_since() ? judge_restart(now) : judge_writers(now);
}

namespace {

/// The group of jobs whose values have changed while others were read; false: there is none.
bool read_once_more(std::list<ReadJob>& jobs, std::vector<dronecan::Job*>& group) {
  group.clear();
  for (ReadJob& job : jobs) {
    if (job.is_outdated()) {
      job.read_anew();
      group.push_back(&job);
    }
  }
  return !group.empty();
}

/// A servo that took the node ID of another one, which moved, was read on both: the other one was
/// not.
void refuse_read_twice(std::vector<Snapshot>& servos, const Roster& roster) {
  std::map<dronecan::UniqueId, Snapshot*> read;
  for (Snapshot& snapshot : servos) {
    const auto& unit = snapshot.servo.unique_id;
    if (snapshot.error || !unit || not_unique(roster, snapshot.servo.id)) {
      continue;
    }
    const auto [earlier, is_first] = read.emplace(*unit, &snapshot);
    if (!is_first) {
      Snapshot& other = *earlier->second;
      const std::uint8_t one = other.servo.id.value(), two = snapshot.servo.id.value();
      for (Snapshot* each : {&other, &snapshot}) {
        each->error = Error{Code::state, say<texts::read_twice>(one, two),
                            say<texts::run_again_hint>(), each->servo.id.value()};
        each->readings.clear();
      }
    }
  }
}

} // namespace

Snapshots take_snapshots(Session& session, const bla::Profiles& profiles,
                         std::span<const dronecan::NodeId> servos,
                         const Identification::Options& options, const ReadJob::Choice& choice,
                         ReadJob::Proof proof, const ReadJob::More& more) {
  if (session.is_replay()) {
    proof = ReadJob::Proof::none;
  }
  std::list<ReadJob> jobs;
  std::vector<dronecan::Job*> group;
  for (const dronecan::NodeId id : servos) {
    group.push_back(
        &jobs.emplace_back(session.records(), id, profiles, options, choice, proof, more));
  }
  auto ran = session.run(group);
  while (ran && read_once_more(jobs, group)) {
    ran = session.run(group);
  }
  Snapshots snapshots;
  for (const ReadJob& job : jobs) {
    snapshots.servos.push_back(job.snapshot());
  }
  if (!session.is_replay()) {
    refuse_read_twice(snapshots.servos, session.roster());
  }
  if (!ran) {
    snapshots.broken = ran.error();
  }
  return snapshots;
}

} // namespace blactl::fleet
