// How a servo that was commanded is brought to its end, whatever was the reason.

#include "blactl/bla/value.hpp"
#include "blactl/fleet/command_job.hpp"
#include "blactl/fleet/guard.hpp"
#include "blactl/fleet/texts.hpp"

#include "fleet/command_texts.hpp"

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

/// How long a shaft may take to stand, and what its speed may show then, so often in a row (all
/// unproven).
constexpr Duration longest_stop = 1s;
constexpr std::int64_t standing_rpm = 2;
constexpr int standing_samples = 3;

constexpr int silent_in_the_end = 6;

/// A servo that restarts more often meanwhile does so because of it, or of its supply.
constexpr int most_restarts_commanded = 2;

constexpr std::array timeout_registers{at::timeout_action, at::timeout_time};

} // namespace

/// It was not carried out as planned, and is brought to its end.
Step CommandJob::fail(Error error) {
  if (!result_.error) {
    result_.error = std::move(error);
  }
  return finish();
}

Step CommandJob::finish() {
  if (!result_.has_commanded()) {
    return std::nullopt;
  }
  phase_ = Phase::ending;
  ended_ = now_;
  unanswered_ = standing_ = 0;
  reading_ = 0;
  sample_ = {};
  sample_due_ = now_;
  reads_first_ = false;
  has_end_ = !plan_.is_angle();
  return has_end_ ? command(0) : end();
}

/// It is told what to do in the end again and again until it stands.
Step CommandJob::end() {
  if (unanswered_ >= silent_in_the_end) {
    return give_up(silent_since());
  }
  if (has_end_ && standing_ >= standing_samples) {
    phase_ = Phase::ended;
    return read_back();
  }
  if (now_ >= ended_ + longest_stop) {
    return give_up(not_standing());
  }
  return now_ >= command_due() ? command(target_) : sample();
}

/// An angle that is reached is held already; else the one where the shaft is, which lies within
/// the limits as all of its way does.
void CommandJob::choose_end() {
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

bool CommandJob::stands() const {
  const bool is_still = sample_.speed && std::abs(*sample_.speed) <= standing_rpm;
  return is_still &&
         (!plan_.is_angle() || (sample_.angle && is_at(plan_, *sample_.angle, target_)));
}

Error CommandJob::not_standing() const {
  const auto text = [&](std::size_t reading, const std::optional<std::int64_t>& raw) {
    return raw ? bla::display(*plan_.readings.at(reading).parameter, *raw) : std::string("?");
  };
  const bool is_still = sample_.speed && std::abs(*sample_.speed) <= standing_rpm;
  return {Code::mismatch,
          plan_.is_angle() && is_still
              ? say<texts::motion_not_held>(id(), bla::display(*plan_.parameter, target_),
                                            text(0, sample_.angle))
              : say<texts::motion_still_turns>(id(), text(1, sample_.speed)),
          say<texts::motion_why_hint>(id()), id()};
}

/// What it does from now on is told by what it holds now.
Step CommandJob::read_timeout() {
  at_ = At::timeout;
  return read_register(servo_.id, timeout_registers.front(), options_.patience);
}

Step CommandJob::judge_timeout(const Outcome& outcome) {
  const Address address = timeout_registers[result_.timeout.size()];
  const auto raw = value(outcome, address);
  if (!raw) {
    return give_up(no_answer(outcome, servo_.id, servo_.identity.parameter(address)->name));
  }
  result_.timeout[address] = *raw;
  if (result_.timeout.size() < timeout_registers.size()) {
    return read_register(servo_.id, timeout_registers.back(), options_.patience);
  }
  at_ = At::proof;
  proof_.emplace(roster_, servo_, servo_.since, options_.patience);
  return proof_->next({Outcome::Kind::start, {}, now_});
}

/// It restarted: whether it is still the same, before anything is written to it again.
Step CommandJob::recognise() {
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
  if (++restarts_ > most_restarts_commanded) {
    return give_up(*result_.error);
  }
  phase_ = Phase::moving; // its end begins anew
  servo_.boot = roster_.member(servo_.id).boots;
  servo_.since = now_;
  at_ = At::proof;
  proof_.emplace(roster_, servo_, std::nullopt, options_.patience);
  return proof_->next({Outcome::Kind::start, {}, now_});
}

Step CommandJob::judge_proof(const Outcome& outcome) {
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
  result_.is_ended = true;
  return std::nullopt;
}

/// Nothing may be written to it any more, or nothing comes of it.
Step CommandJob::give_up(Error error) {
  const bool is_left = error.code == Code::armed || error.code == Code::driven;
  if (result_.has_commanded() && !is_left) {
    error.message = say<texts::motion_not_ended>(id(), error.message);
    error.hint = say<texts::motion_not_ended_hint>(after_commands(plan_, result_), id());
  }
  if (result_.error && result_.has_commanded() && result_.error->message != error.message) {
    result_.error->message = say<texts::motion_nor_ended>(result_.error->message, error.message);
    result_.error->hint = error.hint;
  } else {
    result_.error = std::move(error);
  }
  return std::nullopt;
}

} // namespace blactl::fleet
