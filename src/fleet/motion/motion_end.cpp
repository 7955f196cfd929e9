// Brings a commanded servo to its end, for any reason.

#include "blactl/bla/faults.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/motion/motion_job.hpp"

#include "fleet/motion/motion_texts.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using dronecan::Outcome;
using dronecan::Step;
using namespace std::chrono_literals;

namespace {

/// The time that a shaft may take to stand still, and the time it is watched if few responses come;
/// the speed that may show then, the number of such samples in a row and their duration, and the
/// angle that it may move meanwhile, in tenths of a degree (all unproven).
constexpr Duration longest_stop = 1s, longest_look = 3s;
constexpr std::int64_t standing_rpm = 2;
constexpr int standing_samples = 3;
constexpr Duration standing_time = 150ms;
constexpr std::int64_t most_creep = 5;

/// A servo that restarts more often does so because of the command, or of its supply.
constexpr int most_restarts_commanded = 2;

constexpr std::array end_registers{at::torque_output, at::timeout_action, at::timeout_time};

} // namespace

Step MotionJob::fail(Error error) {
  if (!result_.error) {
    result_.error = std::move(error);
  }
  return finish();
}

Step MotionJob::finish() {
  if (!result_.has_commanded()) {
    return std::nullopt;
  }
  phase_ = Phase::ending;
  ended_ = now_;
  unanswered_ = standing_ = 0;
  answered_ = now_; // it has all of its time again
  reading_ = 0;
  sample_ = stood_ = {};
  seen_.reset();
  has_crept_ = false;
  sample_due_ = now_;
  reads_first_ = false;
  has_end_ = !plan_.is_angle();
  if (has_end_) {
    target_ = 0;
    last_command_ = now_ - plan_.longest_gap; // due at once
  }
  return go_on();
}

/// Repeats the final command until the shaft stands still.
Step MotionJob::end() {
  if (is_silent()) {
    return give_up(silent_since());
  }
  if (standing_ >= standing_samples && seen_->at - stood_.at >= standing_time) {
    phase_ = Phase::ended;
    return read_back();
  }
  const bool may_stand = has_end_ && (!seen_ || standing_ > 0);
  if (now_ >= ended_ + (may_stand ? longest_look : longest_stop)) {
    return give_up(not_standing());
  }
  return now_ >= command_due() ? command(target_) : sample();
}

/// An angle that was reached is held already; else the present angle, which lies within the limits
/// like all of its way.
void MotionJob::choose_end() {
  has_end_ = true;
  const bool arrived = is_at(plan_, *sample_.angle, plan_.last_target());
  target_ = plan_.last_target();
  if (!arrived || result_.error) {
    const auto& [parameter, low, high] = plan_.readings.front();
    target_ =
        std::clamp(*sample_.angle, low.value_or(*sample_.angle), high.value_or(*sample_.angle));
    result_.held = target_;
  }
  last_command_ = now_ - plan_.longest_gap; // due at once
}

/// Both speed and angle must show it. A sample with a missing value shows nothing.
void MotionJob::watch_standing() {
  if (!sample_.angle || !sample_.speed) {
    return;
  }
  seen_ = sample_;
  if (standing_ > 0 && between(*sample_.angle, *stood_.angle) > most_creep) {
    has_crept_ = true;
    standing_ = 0;
  }
  if (standing_ == 0) {
    stood_ = sample_;
  }
  standing_ = stands(sample_) ? standing_ + 1 : 0;
}

bool MotionJob::stands(const MotionSample& sample) const {
  return std::abs(*sample.speed) <= standing_rpm &&
         (!plan_.is_angle() || is_at(plan_, *sample.angle, target_));
}

Error MotionJob::not_standing() const {
  const std::string hint = say<texts::motion_why_hint>(id());
  if (!seen_ || (standing_ > 0 && !has_crept_)) {
    return {Code::timeout, say<texts::motion_not_seen_standing>(id()), hint, id()};
  }
  const auto text = [&](std::size_t reading, std::int64_t raw) {
    return bla::display(*plan_.readings.at(reading).parameter, raw);
  };
  const std::string angle = text(0, *seen_->angle);
  if (std::abs(*seen_->speed) > standing_rpm) {
    return {Code::mismatch, say<texts::motion_still_turns>(id(), text(1, *seen_->speed)), hint,
            id()};
  }
  return {Code::mismatch,
          plan_.is_angle() && !stands(*seen_)
              ? say<texts::motion_not_held>(id(), bla::display(*plan_.parameter, target_), angle)
              : say<texts::motion_still_moves>(id(), angle),
          hint, id()};
}

/// The servo's further behaviour follows from its present settings.
Step MotionJob::read_settings() {
  at_ = At::settings;
  result_.output.reset();
  result_.protection.reset();
  result_.timeout.clear();
  faults_.clear();
  return read_register(servo_.id, end_registers.front(), options_.patience);
}

Step MotionJob::judge_setting(const Outcome& outcome) {
  std::size_t told = result_.timeout.size() + (result_.output ? 1U : 0U);
  const Address address = end_registers.at(told);
  const auto raw = value(outcome, address);
  if (!raw) {
    return give_up(no_answer(outcome, servo_.id, servo_.identity.parameter(address)->name));
  }
  if (address == at::torque_output) {
    result_.output = raw;
  } else {
    result_.timeout[address] = *raw;
  }
  if (++told < end_registers.size()) {
    return read_register(servo_.id, end_registers.at(told), options_.patience);
  }
  at_ = At::faults;
  asked_ = at::fault_summary;
  return read_register(servo_.id, asked_, options_.patience);
}

/// The next register that the faults found so far ask for.
Step MotionJob::read_faults() {
  for (const Address address : bla::fault_details(faults_, roster_.profiles())) {
    if (servo_.identity.parameter(address) != nullptr) {
      asked_ = address;
      return read_register(servo_.id, asked_, options_.patience);
    }
  }
  return prove();
}

Step MotionJob::judge_fault(const Outcome& outcome) {
  const auto raw = value(outcome, asked_);
  if (!raw) {
    return give_up(no_answer(outcome, servo_.id, servo_.identity.parameter(asked_)->name));
  }
  faults_.insert_or_assign(asked_, *raw);
  return read_faults();
}

Step MotionJob::prove() {
  for (const bla::Fault& fault : bla::faults(faults_, roster_.profiles())) {
    if (!result_.protection && bla::holds_output_off(fault, faults_) == true) {
      result_.protection = fault;
    }
  }
  at_ = At::proof;
  proof_.emplace(roster_, servo_, servo_.since, options_.patience);
  return proof_->next({Outcome::Kind::start, {}, now_});
}

/// Without output nothing is held, and nothing that was commanded is done, however well its
/// registers show the command.
void MotionJob::judge_output() {
  if (result_.protection) {
    const bla::FaultBit& bit = *result_.protection->known;
    add_error({Code::state, say<texts::motion_protected>(id(), choose(bit.text_en, bit.text_ja)),
               say<texts::motion_why_hint>(id()), id()});
  } else if (plan_.is_angle() && !holds(plan_, result_)) {
    const bla::Parameter& output = *servo_.identity.parameter(at::torque_output);
    add_error(
        {Code::state,
         say<texts::motion_not_holding>(id(), output.name, bla::display(output, *result_.output)),
         say<texts::motion_not_holding_hint>(output.name, id()), id()});
  }
}

/// It restarted: checks that it is the same unit, before anything is written to it again.
Step MotionJob::recognise() {
  if (!result_.has_commanded()) {
    return give_up({Code::state, say<texts::restarted_before_write>(id()),
                    say<texts::run_again_hint>(), id()});
  }
  if (!result_.error) {
    result_.error = Error{Code::state, say<texts::motion_restarted>(id()),
                          say<texts::motion_restarted_hint>(id()), id()};
  }
  result_.has_restarted = true;
  result_.timeout.clear();
  result_.output.reset();
  if (++restarts_ > most_restarts_commanded) {
    return give_up(*result_.error);
  }
  phase_ = Phase::moving; // its end starts over
  servo_.boot = roster_.member(servo_.id).boots;
  servo_.since = now_;
  at_ = At::proof;
  proof_.emplace(roster_, servo_, std::nullopt, options_.patience);
  return proof_->next({Outcome::Kind::start, {}, now_});
}

/// What another node began after the last reading.
std::optional<Error> MotionJob::disturbed_in_the_end() const {
  if (auto why = forbidden(); why && why->code == Code::driven) {
    return why;
  }
  const auto writer = roster_.writer_to(servo_.id, looked_at_);
  return writer
             ? std::optional(Error{Code::state, say<texts::written_by_other>(id(), writer->value()),
                                   say<texts::other_writer_hint>(), id()})
             : std::nullopt;
}

Step MotionJob::judge_proof(const Outcome& outcome) {
  if (Step step = proof_->next(outcome); !step.is_end()) {
    return step;
  }
  switch (proof_->verdict()) {
  case RunProof::Verdict::failed: return give_up(*proof_->error());
  case RunProof::Verdict::restarted: return recognise();
  case RunProof::Verdict::too_late:
    return give_up(
        {Code::state, say<texts::written_too_late>(id()), say<texts::run_again_hint>(), id()});
  case RunProof::Verdict::ran_on: break;
  }
  if (phase_ != Phase::ended) {
    auto why = forbidden();
    return why ? give_up(std::move(*why)) : finish();
  }
  if (auto why = result_.error ? std::nullopt : disturbed_in_the_end()) {
    return give_up(std::move(*why));
  }
  result_.is_ended = true;
  judge_output();
  return std::nullopt;
}

void MotionJob::add_error(Error error) {
  if (!result_.error) {
    result_.error = std::move(error);
  } else if (result_.error->message != error.message) {
    result_.error->message = say<texts::motion_nor_ended>(result_.error->message, error.message);
    result_.error->hint = std::move(error.hint);
  }
}

/// Nothing more may be written to it, or writing has no effect. If another unit responds on the ID,
/// its uptime says nothing about the commanded servo, which cannot be reached any more.
Step MotionJob::give_up(Error error) {
  const bool is_left = error.code == Code::armed || error.code == Code::driven;
  const bool has_met_another =
      error.code == Code::duplicate_node_id || is_another_ || (proof_ && proof_->has_met_another());
  if (result_.has_commanded() && has_met_another) {
    result_.has_restarted = false;
    result_.error.reset();
  }
  if (result_.has_commanded() && !is_left) {
    const std::string then = after_commands(plan_, result_);
    error.message = say<texts::motion_not_ended>(id(), error.message);
    error.hint = has_met_another ? say<texts::motion_cut_hint>(then)
                                 : say<texts::motion_not_ended_hint>(then, id());
  }
  add_error(std::move(error));
  return std::nullopt;
}

} // namespace blactl::fleet
