#include "blactl/fleet/motion/motion_job.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/array_command.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/guard.hpp"

#include "fleet/motion/motion_texts.hpp"

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

/// A request is given up after this time, or this multiple of the slowest response so far; the time
/// doubles with each one that stays unanswered. So a lost frame costs little.
constexpr Duration soon = 20ms;
constexpr int times_slowest = 4;
constexpr int most_doublings = 6;

/// After this number of consecutive requests without a response the servo is taken to be gone.
constexpr int silent_while_moving = 3, silent_in_the_end = 6;

/// Another unit on its node ID may have been switched on in a silence that is longer than this
/// (unproven), and than the servo takes to answer: it sends actuator.Status ten times a second.
constexpr Duration longest_silence = 50ms;
constexpr int times_latest = 2;

/// No command goes out until it has answered, so it is asked often.
constexpr int tries_who = 3;

/// The angle that a shaft may have moved since the user's question, in tenths of a degree; and the
/// angle that a turning one, as after a soft start, goes on to turn in 0.2 s, per rpm.
constexpr std::int64_t most_moved = 20, moved_per_rpm = 12;

constexpr std::array readings{at::current_angle, at::current_speed, at::current_torque};

} // namespace

MotionJob::MotionJob(const Roster& roster, const MotionPlan& plan, Options options)
    : roster_(roster), plan_(plan), options_(std::move(options)), servo_(plan.servo()),
      conditions_(plan.conditions()), others_(roster) {}

Step MotionJob::next(const Outcome& outcome) {
  now_ = options_.now();
  if (outcome.answered()) {
    answered_ = now_;
    latest_ = outcome.at - outcome.asked;
    slowest_ = std::max(slowest_, latest_);
  }
  if (outcome.kind == Outcome::Kind::cancelled) {
    return give_up(no_answer(outcome, servo_.id, plan_.parameter->name));
  }
  switch (at_) {
  case At::begin:
    at_ = At::unit;
    return ask(servo_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
  case At::unit: return judge_unit(outcome);
  case At::look: return judge_condition(outcome);
  case At::pause: return go_on();
  case At::write: return judge_echo(outcome);
  case At::shown: return judge_shown(outcome);
  case At::read: return take_sample(outcome);
  case At::settings: return judge_setting(outcome);
  case At::faults: return judge_fault(outcome);
  case At::who: return judge_who(outcome);
  case At::proof: break;
  }
  return judge_proof(outcome);
}

/// Between the question and the user's reply another unit may have come to the node ID.
Step MotionJob::judge_unit(const Outcome& outcome) {
  if (!outcome.answered()) {
    return give_up(no_answer(outcome, servo_.id, "GetNodeInfo"));
  }
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (!info || info->unique_id != servo_.unique_id) {
    return give_up(
        {Code::state, say<texts::another_servo>(id()), say<texts::run_again_hint>(), id()});
  }
  looked_at_ = heard_ = now_;
  return look();
}

Step MotionJob::look() {
  if (result_.is_cut || conditions_.empty()) {
    sample_due_ = now_;
    return go_on();
  }
  at_ = At::look;
  return read_register(servo_.id, conditions_.begin()->first, options_.patience);
}

Step MotionJob::judge_condition(const Outcome& outcome) {
  const auto [address, expected] = *conditions_.begin();
  const bla::Parameter& parameter = *servo_.identity.parameter(address);
  const auto raw = register_value(outcome, servo_.id, address, parameter.width);
  if (!raw) {
    return give_up(raw.error());
  }
  const std::int64_t turned = std::abs(plan_.plan.before.raw(at::current_speed).value_or(0));
  const std::int64_t slack = address == at::current_angle ? most_moved + turned * moved_per_rpm : 0;
  if (std::abs(*raw - expected) > slack) {
    return give_up({Code::state,
                    say<texts::motion_changed>(id(), parameter.name, bla::display(parameter, *raw),
                                               bla::display(parameter, expected)),
                    say<texts::run_again_hint>(), id()});
  }
  conditions_.erase(conditions_.begin());
  return look();
}

/// Conditions that forbid writing, whatever was agreed.
std::optional<Error> MotionJob::forbidden() const {
  auto why = Guard(roster_, options_.while_driven).forbids(servo_, now_);
  if (why && why->code != Code::duplicate_node_id) {
    why->hint = after_commands(plan_, result_);
  }
  return why;
}

/// The reason why it must not continue as agreed.
std::optional<Error> MotionJob::disturbed() const {
  const auto writer = roster_.writer_to(servo_.id, looked_at_);
  if (const auto other = writer ? writer : roster_.renumbered_by(servo_)) {
    return Error{Code::state, say<texts::written_by_other>(id(), other->value()),
                 say<texts::other_writer_hint>(), id()};
  }
  if (const auto other = newcomer()) {
    const auto servo_id = plan_.plan.before.raw(at::servo_id).value_or(0);
    return Error{Code::duplicate_servo_id, say<texts::motion_newcomer>(other->value(), servo_id),
                 say<texts::motion_servo_id_hint>(), id()};
  }
  const Duration gap = now_ - last_command_;
  if (result_.has_commanded() && gap > plan_.timeout) {
    return Error{Code::state,
                 say<texts::motion_not_repeated>(
                     id(), std::chrono::duration_cast<std::chrono::milliseconds>(gap).count()),
                 say<texts::motion_not_repeated_hint>(), id()};
  }
  return std::nullopt;
}

std::optional<NodeId> MotionJob::newcomer() const {
  const auto servo_id = plan_.plan.before.raw(at::servo_id);
  return plan_.by_servo_id && servo_id ? others_.obeys(roster_, servo_, *servo_id) : std::nullopt;
}

bool MotionJob::has_restarted() const {
  return roster_.member(servo_.id).boots != servo_.boot;
}

/// Another unit that has taken its place shows by its NodeStatus only up to a second later. A
/// process that reads its frames late has not heard a silence: what it was told last, counts.
bool MotionJob::may_be_another() {
  const Member* member = roster_.find(servo_.id);
  const Time heard = std::max(told_who_, member != nullptr ? member->last_heard : now_);
  const Time before = std::exchange(heard_, heard);
  is_unsure_ = is_unsure_ || std::max(heard - before, now_ - heard) >
                                 std::max<Duration>(longest_silence, times_latest * latest_);
  return is_unsure_;
}

Step MotionJob::go_on() {
  if (auto why = forbidden()) {
    return give_up(std::move(*why));
  }
  if (has_restarted()) {
    return recognise();
  }
  if (may_be_another()) {
    at_ = At::who;
    return read_register(servo_.id, at::serial_number, {patient_time(tries_who), 0});
  }
  return phase_ == Phase::moving ? move() : end();
}

/// Nothing is written until it has told its serial number. That answer has fewer frames than
/// GetNodeInfo, and frames may get lost.
Step MotionJob::judge_who(const Outcome& outcome) {
  if (!has_answered(outcome)) {
    return phase_ == Phase::ending && is_silent() ? give_up(silent_since()) : go_on_unless_silent();
  }
  is_unsure_ = false;
  told_who_ = heard_ = now_;
  is_another_ = value(outcome, at::serial_number) != servo_.identity.readings().serial_number;
  return is_another_ ? give_up({Code::state, say<texts::another_servo>(id()),
                                say<texts::run_again_hint>(), id()})
                     : go_on();
}

Step MotionJob::move() {
  if (auto why = disturbed()) {
    return fail(std::move(*why));
  }
  const Duration after = result_.has_commanded() ? now_ - result_.began : Duration{};
  if (result_.is_cut || after >= plan_.duration) {
    return finish();
  }
  const std::int64_t target = plan_.target_at(after);
  const bool is_due = !result_.has_commanded() || now_ >= command_due();
  return is_due || target != target_ ? command(target) : sample();
}

/// Late responses leave time for either a command or a read: they take turns, as far as the servo's
/// timeout allows. While the angle to end at is still being read, reads have precedence.
Time MotionJob::command_due() const {
  const bool reads = reads_first_ || (phase_ == Phase::ending && !has_end_);
  return last_command_ + (reads ? plan_.longest_gap : plan_.period);
}

Step MotionJob::command(std::int64_t raw) {
  target_ = raw;
  last_command_ = now_;
  reads_first_ = true;
  const Address address = plan_.parameter->address;
  const bool is_end = phase_ != Phase::moving;
  if (!is_end && result_.commands++ == 0) {
    result_.began = now_;
  }
  if (plan_.by_servo_id && (!is_end || raw == 0)) { // others with this servo ID stop with it
    const auto servo_id = plan_.plan.before.raw(at::servo_id).value_or(0);
    options_.broadcast(array_command(static_cast<std::uint8_t>(servo_id), address, raw));
  }
  if (plan_.by_servo_id && !is_end) {
    return read_back();
  }
  at_ = At::write;
  return write_register(servo_.id, address, raw, once()); // forbidden() was asked in this step
}

/// In this time it responds, unless a frame was lost.
Duration MotionJob::usual_time() const {
  return std::max(soon, times_slowest * slowest_);
}

/// The time for a request: it doubles with each such number of them that stay unanswered.
Duration MotionJob::patient_time(int unanswered) const {
  const auto doublings = static_cast<unsigned>(std::min(unanswered_ / unanswered, most_doublings));
  return std::min(options_.patience.timeout, usual_time() * (1U << doublings));
}

/// One request, answered or given up in time for the next command.
Patience MotionJob::once() const {
  constexpr Duration least = 1ms;
  const Duration left = last_command_ + plan_.longest_gap - now_;
  return {std::max(least, std::min(left, patient_time(1))), 0};
}

/// No response to several requests, nor in the time that three of them may take.
bool MotionJob::is_silent() const {
  constexpr int of_patience = 3;
  const int most = phase_ == Phase::moving ? silent_while_moving : silent_in_the_end;
  return unanswered_ >= most && now_ - answered_ >= of_patience * options_.patience.timeout;
}

/// False: again there was no response. Too many of them end the command.
bool MotionJob::has_answered(const Outcome& outcome) {
  unanswered_ = outcome.answered() ? 0 : unanswered_ + 1;
  return outcome.answered();
}

std::optional<std::int64_t> MotionJob::value(const Outcome& outcome, Address address) const {
  const bla::Parameter* parameter = servo_.identity.parameter(address);
  const auto raw = register_value(outcome, servo_.id, address, parameter->width);
  return raw ? std::optional(*raw) : std::nullopt;
}

Step MotionJob::judge_echo(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::not_sent) {
    auto unsent = no_answer(outcome, servo_.id, plan_.parameter->name);
    return phase_ == Phase::moving ? fail(std::move(unsent)) : give_up(std::move(unsent));
  }
  if (!has_answered(outcome)) {
    return go_on_unless_silent();
  }
  const auto echo = value(outcome, plan_.parameter->address);
  if (echo == target_) {
    return result_.is_shown || phase_ != Phase::moving ? go_on() : read_back();
  }
  return phase_ == Phase::moving ? fail(not_taken(echo, Code::refused))
                                 : give_up(not_taken(echo, Code::mismatch));
}

/// A response only echoes the request; reading the register shows its value.
Step MotionJob::read_back() {
  at_ = At::shown;
  return read_register(servo_.id, plan_.parameter->address,
                       phase_ == Phase::moving ? once() : options_.patience);
}

/// unproven: that the register shows an ArrayCommand.
Step MotionJob::judge_shown(const Outcome& outcome) {
  const auto held = value(outcome, plan_.parameter->address);
  const bool is_known = has_answered(outcome);
  if (phase_ != Phase::moving) {
    if (!is_known) {
      return give_up(no_answer(outcome, servo_.id, plan_.parameter->name));
    }
    return held == target_ ? read_settings() : give_up(not_taken(held, Code::mismatch));
  }
  if (is_known && held != target_ && !plan_.by_servo_id) {
    return fail(not_taken(held, Code::refused));
  }
  result_.is_shown = result_.is_shown || (is_known && held == target_);
  return go_on_unless_silent();
}

Step MotionJob::go_on_unless_silent() {
  return phase_ == Phase::moving && is_silent() ? fail(silent_since()) : go_on();
}

Error MotionJob::silent_since() const {
  return {Code::timeout, say<texts::motion_silent>(id()), say<texts::no_answer_hint>(), id()};
}

Error MotionJob::not_taken(std::optional<std::int64_t> held, Code code) const {
  const auto text = [this](std::int64_t raw) { return bla::display(*plan_.parameter, raw); };
  return {code,
          say<texts::motion_not_taken>(id(), plan_.parameter->name, text(target_),
                                       held ? say<texts::motion_holds>(text(*held))
                                            : say<texts::motion_no_value>()),
          say<texts::motion_why_hint>(id()), id()};
}

/// Reads the next value of a sample, or pauses until it is due.
Step MotionJob::sample() {
  if (reading_ == 0 && now_ < sample_due_) {
    at_ = At::pause;
    const Time end = phase_ == Phase::moving ? result_.began + plan_.duration : never;
    return dronecan::Pause{.until = std::min({sample_due_, command_due(), end}),
                           .ready = [this] { return result_.is_cut && phase_ == Phase::moving; }};
  }
  at_ = At::read;
  reads_first_ = false;
  return read_register(servo_.id, readings[reading_], once());
}

/// The servo measured its angle between the request and the response.
Step MotionJob::take_sample(const Outcome& outcome) {
  const auto raw = has_answered(outcome) ? value(outcome, readings[reading_]) : std::nullopt;
  if (reading_ == 0) {
    const Time asked = outcome.answered() ? outcome.asked : outcome.at;
    const Time between = asked + (outcome.at - asked) / 2;
    sample_ = {.at = between, .after = between - result_.began, .target = target_, .angle = raw};
  } else {
    (reading_ == 1 ? sample_.speed : sample_.torque) = raw;
  }
  if (++reading_ == readings.size()) {
    conclude_sample();
  }
  return go_on_unless_silent();
}

void MotionJob::conclude_sample() {
  reading_ = 0;
  sample_due_ = std::max(sample_due_ + sample_period, now_);
  result_.samples.push_back(sample_);
  if (options_.sampled) {
    options_.sampled(sample_);
    now_ = options_.now(); // the consumer may be slow
  }
  if (phase_ == Phase::ending && has_end_) {
    watch_standing();
  } else if (phase_ == Phase::ending && sample_.angle) {
    choose_end();
  }
}

} // namespace blactl::fleet
