#include "blactl/fleet/command_job.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/fleet/array_command.hpp"
#include "blactl/fleet/conflict_texts.hpp"
#include "blactl/fleet/guard.hpp"
#include "blactl/fleet/restart_texts.hpp"
#include "blactl/fleet/texts.hpp"

#include "fleet/command_texts.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using dronecan::GetNodeInfo;
using dronecan::NodeId;
using dronecan::Outcome;
using dronecan::Step;
using namespace std::chrono_literals;

namespace {

/// Angle, speed and torque take 1.6 ms of the bus: a sixth of it.
constexpr Duration sample_period = 10ms;

/// A servo that leaves so many questions in a row unanswered is not there any more.
constexpr int most_silent = 3;

/// How long a shaft may take to stand, and what it may show then (both unproven).
constexpr Duration longest_stop = 1s;
constexpr std::int64_t standing_rpm = 1;

constexpr std::array readings{at::current_angle, at::current_speed, at::current_torque};

} // namespace

CommandJob::CommandJob(const Roster& roster, const CommandPlan& plan, Options options)
    : roster_(roster), plan_(plan), options_(std::move(options)), conditions_(plan.conditions()) {
  for (const auto& [id, member] : roster_.members()) {
    others_.push_back(id);
  }
}

Step CommandJob::next(const Outcome& outcome) {
  now_ = options_.now();
  if (outcome.kind == Outcome::Kind::cancelled) {
    return give_up(no_answer(outcome, plan_.servo().id, plan_.parameter->name));
  }
  switch (at_) {
  case At::begin:
    at_ = At::unit;
    return ask(plan_.servo().id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(),
               options_.patience);
  case At::unit: return judge_unit(outcome);
  case At::look: return judge_condition(outcome);
  case At::run: return go_on();
  case At::write: return judge_echo(outcome);
  case At::shown: return judge_shown(outcome);
  case At::read: return take_sample(outcome);
  case At::end_write: return judge_end(outcome);
  case At::end: return end_sample();
  case At::proof: break;
  }
  return judge_proof(outcome);
}

/// Between the question and the answer of a person another unit may have come to the node ID.
Step CommandJob::judge_unit(const Outcome& outcome) {
  if (!outcome.answered()) {
    return give_up(no_answer(outcome, plan_.servo().id, "GetNodeInfo"));
  }
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (!info || info->unique_id != plan_.servo().unique_id) {
    return give_up(
        {Code::state, say<texts::another_servo>(id()), say<texts::run_again_hint>(), id()});
  }
  return look();
}

/// The next of the settings that the plan rests on.
Step CommandJob::look() {
  if (result_.is_cut || conditions_.empty()) {
    sample_due_ = now_;
    return go_on();
  }
  at_ = At::look;
  return read_register(plan_.servo().id, conditions_.begin()->first, options_.patience);
}

Step CommandJob::judge_condition(const Outcome& outcome) {
  const auto [address, expected] = *conditions_.begin();
  const bla::Parameter& parameter = *plan_.servo().identity.parameter(address);
  const auto raw = register_value(outcome, plan_.servo().id, address, parameter.width);
  if (!raw) {
    return give_up(raw.error());
  }
  if (*raw != expected) {
    return give_up({Code::state,
                    say<texts::motion_changed>(id(), parameter.name, bla::display(parameter, *raw),
                                               bla::display(parameter, expected)),
                    say<texts::run_again_hint>(), id()});
  }
  conditions_.erase(conditions_.begin());
  return look();
}

/// What must never be written to, whatever was agreed.
std::optional<Error> CommandJob::forbidden() const {
  const Servo& servo = plan_.servo();
  if (roster_.is_doubled(servo.id)) {
    return doubled(roster_, servo.id);
  }
  if (roster_.member(servo.id).boots != servo.boot) {
    return Error{Code::state, say<texts::motion_restarted>(id()),
                 say<texts::motion_restarted_hint>(id()), id()};
  }
  if (const auto by = roster_.armed_by()) {
    return Error{Code::armed, say<texts::armed>(by->value()), say<texts::armed_hint>(), id()};
  }
  const auto driver = roster_.driver_of(servo, now_);
  if (driver && !options_.while_driven) {
    return Error{Code::driven, say<texts::driven>(driver->value(), id()), say<texts::driven_hint>(),
                 id()};
  }
  return std::nullopt;
}

/// A node that came since an ArrayCommand is told to everybody: it may have the same servo ID.
std::optional<NodeId> CommandJob::newcomer() const {
  for (const auto& [id, member] : roster_.members()) {
    if (plan_.by_servo_id && member.sends_actuator_status() &&
        std::ranges::find(others_, id) == others_.end()) {
      return id;
    }
  }
  return std::nullopt;
}

/// The next command, the next question, or neither yet.
Step CommandJob::go_on() {
  if (auto why = forbidden()) {
    return give_up(std::move(*why));
  }
  const auto servo_id = plan_.plan.before.raw(at::servo_id).value_or(0);
  if (const auto other = newcomer()) {
    return fail({Code::duplicate_servo_id, say<texts::motion_newcomer>(other->value(), servo_id),
                 say<texts::motion_servo_id_hint>(), id()});
  }
  const Duration gap = now_ - last_command_;
  if (result_.has_commanded() && gap > plan_.timeout) {
    return fail({Code::state,
                 say<texts::motion_not_repeated>(
                     id(), std::chrono::duration_cast<std::chrono::milliseconds>(gap).count()),
                 say<texts::motion_not_repeated_hint>(), id()});
  }
  const bool is_over = result_.has_commanded() && now_ >= result_.began + plan_.duration;
  if (result_.is_cut || is_over) {
    return finish();
  }
  const Duration since = result_.has_commanded() ? now_ - result_.began : Duration{};
  const bool is_due = !result_.has_commanded() || now_ >= last_command_ + plan_.period;
  if (is_due || plan_.target_at(since) != target_) {
    return command();
  }
  return ask_sample();
}

Step CommandJob::command() {
  target_ = plan_.target_at(result_.has_commanded() ? now_ - result_.began : Duration{});
  last_command_ = now_;
  if (result_.commands++ == 0) {
    result_.began = now_;
  }
  at_ = At::write;
  const Patience once = patience_until(now_ + plan_.longest_gap);
  const Address address = plan_.parameter->address;
  if (!plan_.by_servo_id) {
    return write_register(plan_.servo().id, address, target_, once);
  }
  const auto servo_id = plan_.plan.before.raw(at::servo_id).value_or(0);
  options_.broadcast(array_command(static_cast<std::uint8_t>(servo_id), address, target_));
  at_ = At::shown;
  return read_register(plan_.servo().id, address, once);
}

/// There is no answer to an ArrayCommand. unproven: that the register shows it.
Step CommandJob::judge_shown(const Outcome& outcome) {
  if (has_answered(outcome)) {
    result_.is_shown = result_.is_shown || value(outcome, plan_.parameter->address) == target_;
  }
  return unanswered_ < most_silent ? go_on() : fail(silent_since());
}

/// One question, answered or given up in time for the next command.
Patience CommandJob::patience_until(Time deadline) const {
  constexpr Duration least = 1ms;
  return {std::max(least, std::min(deadline - now_, options_.patience.timeout)), 0};
}

/// False: again it did not. Too often is the end.
bool CommandJob::has_answered(const Outcome& outcome) {
  unanswered_ = outcome.answered() ? 0 : unanswered_ + 1;
  return outcome.answered();
}

std::optional<std::int64_t> CommandJob::value(const Outcome& outcome, Address address) const {
  const bla::Parameter* parameter = plan_.servo().identity.parameter(address);
  const auto raw = register_value(outcome, plan_.servo().id, address, parameter->width);
  return raw ? std::optional(*raw) : std::nullopt;
}

Step CommandJob::judge_echo(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::not_sent) {
    return fail(no_answer(outcome, plan_.servo().id, plan_.parameter->name));
  }
  if (!has_answered(outcome)) {
    return unanswered_ < most_silent ? go_on() : fail(silent_since());
  }
  const auto echo = value(outcome, plan_.parameter->address);
  if (echo != target_) {
    return fail(not_taken(echo, Code::refused));
  }
  result_.is_shown = true;
  return go_on();
}

Error CommandJob::silent_since() const {
  return {Code::timeout, say<texts::motion_silent>(id()), say<texts::no_answer_hint>(), id()};
}

Error CommandJob::not_taken(std::optional<std::int64_t> held, Code code) const {
  const auto text = [this](std::int64_t raw) { return bla::display(*plan_.parameter, raw); };
  return {code,
          say<texts::motion_not_taken>(id(), plan_.parameter->name, text(target_),
                                       held ? text(*held) : "?"),
          say<texts::motion_why_hint>(id()), id()};
}

/// The next question of a sample, or a pause until it is due.
Step CommandJob::ask_sample() {
  const Time next_command = is_ending_ ? never : last_command_ + plan_.period;
  const Time end = is_ending_ ? never : result_.began + plan_.duration;
  if (reading_ == 0 && now_ < sample_due_) {
    at_ = is_ending_ ? At::end : At::run;
    return dronecan::Pause{.until = std::min({sample_due_, next_command, end}),
                           .ready = [this] { return result_.is_cut && !is_ending_; }};
  }
  at_ = At::read;
  const Time latest =
      is_ending_ ? now_ + options_.patience.timeout : last_command_ + plan_.longest_gap;
  return read_register(plan_.servo().id, readings[reading_], patience_until(latest));
}

Step CommandJob::take_sample(const Outcome& outcome) {
  const auto raw = has_answered(outcome) ? value(outcome, readings[reading_]) : std::nullopt;
  if (reading_ == 0) {
    sample_ = angle_sample(outcome, raw);
  } else {
    (reading_ == 1 ? sample_.speed : sample_.torque) = raw;
  }
  if (++reading_ == readings.size()) {
    reading_ = 0;
    sample_due_ = std::max(sample_due_ + sample_period, now_);
    result_.samples.push_back(sample_);
    if (options_.sampled) {
      options_.sampled(sample_); // whoever reads it may be slow
      now_ = options_.now();
    }
  }
  if (unanswered_ >= most_silent && !is_ending_) {
    return fail(silent_since());
  }
  return is_ending_ ? end_sample() : go_on();
}

/// When the servo looked at its angle is between the question and the answer.
CommandSample CommandJob::angle_sample(const Outcome& outcome,
                                       std::optional<std::int64_t> angle) const {
  const Time asked = outcome.answered() ? outcome.asked : outcome.at;
  const Time at = asked + (outcome.at - asked) / 2;
  return {.at = at, .after = at - result_.began, .target = target_, .angle = angle};
}

/// It was not carried out as planned, and is brought to its end.
Step CommandJob::fail(Error error) {
  result_.error = std::move(error);
  return finish();
}

/// Nothing may be written to it any more.
Step CommandJob::give_up(Error error) {
  if (result_.has_commanded()) {
    result_.not_ended = Error{error.code, say<texts::motion_not_ended>(id(), error.message),
                              say<texts::motion_not_ended_hint>(after_commands(plan_), id()), id()};
  }
  if (!result_.error) {
    result_.error = std::move(error);
  }
  return std::nullopt;
}

Step CommandJob::finish() {
  if (!result_.has_commanded()) {
    return std::nullopt;
  }
  is_ending_ = true;
  result_.ended = now_;
  unanswered_ = 0;
  reading_ = 0;
  sample_due_ = now_;
  return plan_.is_angle() ? ask_sample() : write_end(0);
}

Step CommandJob::write_end(std::int64_t raw) {
  if (auto why = forbidden()) {
    return give_up(std::move(*why));
  }
  target_ = raw;
  at_ = At::end_write;
  return write_register(plan_.servo().id, plan_.parameter->address, raw, options_.patience);
}

Step CommandJob::judge_end(const Outcome& outcome) {
  const auto echo = value(outcome, plan_.parameter->address);
  if (!outcome.answered()) {
    return give_up(no_answer(outcome, plan_.servo().id, plan_.parameter->name));
  }
  if (echo != target_) {
    return give_up(not_taken(echo, Code::mismatch));
  }
  unanswered_ = 0;
  sample_ = {};
  sample_due_ = outcome.at;
  return ask_sample();
}

/// It is watched until it is where it shall stay.
Step CommandJob::end_sample() {
  if (unanswered_ >= most_silent) {
    return give_up(silent_since());
  }
  const bool is_whole = reading_ == 0 && sample_.angle && sample_.speed;
  if (!is_whole) {
    return ask_sample();
  }
  return plan_.is_angle() ? hold() : stand();
}

/// An angle that is reached is held already.
Step CommandJob::hold() {
  if (result_.held || (has_arrived(plan_, result_) && !result_.error)) {
    return prove();
  }
  result_.held = sample_.angle;
  return write_end(*result_.held);
}

Step CommandJob::stand() {
  if (std::abs(*sample_.speed) <= standing_rpm) {
    return prove();
  }
  if (now_ < result_.ended + longest_stop) {
    return ask_sample();
  }
  const bla::Parameter& parameter = *plan_.servo().identity.parameter(at::current_speed);
  return give_up({Code::mismatch,
                  say<texts::motion_still_turns>(id(), bla::display(parameter, *sample_.speed)),
                  say<texts::motion_why_hint>(id()), id()});
}

Step CommandJob::prove() {
  at_ = At::proof;
  proof_.emplace(roster_, plan_.servo(), plan_.servo().since, options_.patience);
  return proof_->next({Outcome::Kind::start, {}, now_});
}

/// What was proven by a servo that has restarted, or by another one, proves nothing.
Step CommandJob::judge_proof(const Outcome& outcome) {
  if (Step step = proof_->next(outcome); !step.is_end()) {
    return step;
  }
  switch (proof_->verdict()) {
  case RunProof::Verdict::failed: return give_up(*proof_->error());
  case RunProof::Verdict::restarted:
    return give_up({Code::state, say<texts::motion_restarted>(id()),
                    say<texts::motion_restarted_hint>(id()), id()});
  case RunProof::Verdict::too_late:
    return give_up(
        {Code::state, say<texts::written_too_late>(id()), say<texts::run_again_hint>(), id()});
  case RunProof::Verdict::ran_on: break;
  }
  return std::nullopt;
}

} // namespace blactl::fleet
