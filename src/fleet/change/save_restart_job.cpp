#include "blactl/fleet/change/save_restart_job.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/texts.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::fleet {

using dronecan::ExecuteOpcode;
using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::RestartNode;
using dronecan::Step;

namespace {

using namespace std::chrono_literals;

/// The time for a servo to carry out a request whose response was lost, before it is checked. The
/// vendor's updater waits as long (facts, section 6).
constexpr Duration settling_time = 1500ms;

/// The interval of requests to an expected servo that is silent.
constexpr Duration call_period = 1s;

std::string_view name(RestartKind kind) {
  return kind == RestartKind::save ? "SAVE" : "RestartNode";
}

} // namespace

SaveRestartJob::SaveRestartJob(const Roster& roster, const Servo& servo, Options options)
    : roster_(roster), servo_(servo), id_(servo.id),
      unique_id_(servo.unique_id.value_or(dronecan::UniqueId{})), since_(servo.since),
      options_(options), guard_(roster, options.may_be_driven) {}

Step SaveRestartJob::next(const Outcome& outcome) {
  ended_at_ = outcome.at;

  if (outcome.kind == Outcome::Kind::cancelled) {
    return give_up(
        is_sent_ ? left_waiting()
                 : Error{Code::interrupted, say<texts::not_begun>(id_.value()), {}, id_.value()});
  }
  switch (at_) {
  case At::begin:
    if (outcome.at < options_.start) {
      at_ = At::start;
      return dronecan::Pause{.until = options_.start};
    }
    return ask_unit();
  case At::start:
  case At::young:
  case At::newcomer: return ask_unit();
  case At::unit: return check_unit(outcome);
  case At::proof: return judge_proof(outcome);
  case At::request: return judge_answer(outcome);
  case At::settling:
    if (has_news()) {
      return conclude();
    }
    at_ = At::alive;
    return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
  case At::alive: return judge_life(outcome);
  case At::away: return has_news() ? conclude() : call(outcome.at);
  case At::call: return judge_call(outcome);
  }
  return std::nullopt;
}

Step SaveRestartJob::request(Time now) {
  at_ = At::request;
  boot_ = roster_.member(id_).boots;
  sent_at_ = now;
  if (!std::exchange(is_sent_, true)) {
    first_sent_at_ = now;
  }
  if (options_.pace != nullptr) {
    options_.pace->next = now + options_.pace->distance;
    options_.pace->leaving.insert(id_);
  }
  Patience once = options_.patience;
  once.retries = 0;
  return guard_.guarded(options_.kind == RestartKind::save
                            ? ask(id_, ExecuteOpcode::type,
                                  ExecuteOpcode::Request{.opcode = ExecuteOpcode::save}.encode(),
                                  once)
                            : ask(id_, RestartNode::type, RestartNode::Request{}.encode(), once),
                        servo_, options_.next_servo_id);
}

/// The request did not leave; one that did before was not carried out.
Step SaveRestartJob::hold_off(Time now) {
  is_sent_ = has_run_on_ = !may_repeat_;
  if (options_.pace != nullptr) {
    options_.pace->leaving.erase(id_);
  }
  return give_up(*guard_.forbids(servo_, now, options_.next_servo_id));
}

bool SaveRestartJob::has_answered_ok(dronecan::Bytes payload) const {
  if (options_.kind == RestartKind::save) {
    const auto response = ExecuteOpcode::Response::decode(payload);
    return response && response->ok;
  }
  const auto response = RestartNode::Response::decode(payload);
  return response && response->ok;
}

Step SaveRestartJob::judge_answer(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::withheld) {
    return hold_off(outcome.at);
  }
  if (outcome.answered()) {
    is_confirmed_ = has_answered_ok(outcome.payload);
    if (is_confirmed_) {
      return has_news() ? conclude() : wait_for_return(outcome.at);
    }
    is_refused_ = true;
    if (options_.pace != nullptr &&
        options_.pace->stops_at_failure) { // others wait for the verdict
      options_.pace->next = sent_at_ + settling_time + options_.patience.timeout;
    }
  } else if (outcome.kind == Outcome::Kind::not_sent) {
    has_left_ = false; // it may still leave the kernel's queue
  }
  at_ = At::settling;
  return dronecan::Pause{.until = sent_at_ + settling_time, .ready = [this] { return has_news(); }};
}

/// Without a confirmation, and after a refusal too, the servo's own uptime decides.
Step SaveRestartJob::judge_life(const Outcome& outcome) {
  if (has_news()) {
    return conclude();
  }
  const auto info =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  if (!info || info->unique_id != unique_id_) {
    return wait_for_return(outcome.at);
  }
  if (!runs_on(*info, outcome.at)) {
    has_restarted_ = true;
    return has_news() ? conclude() : wait_for_return(outcome.at);
  }
  if (has_left_ && !is_refused_ && std::exchange(may_repeat_, false)) {
    return request(outcome.at);
  }
  has_run_on_ = true;
  return give_up(not_carried_out());
}

/// It was old enough when the request was sent: only without a restart is it older than that.
bool SaveRestartJob::runs_on(const GetNodeInfo::Response& info, Time now) const {
  return has_run_since(sent_at_, info.status.uptime_s, now);
}

/// Whether the start given by an uptime is after the request. The servo had run for two seconds
/// then, so an earlier start lies at least a second before the request.
bool SaveRestartJob::is_after_request(Time started) const {
  constexpr Duration between = 500ms;
  return started > sent_at_ - between;
}

/// An earlier restart may show late, since uptimes are whole seconds: only one after the request
/// counts.
bool SaveRestartJob::has_started_anew() const {
  const auto started = roster_.started(id_);
  return roster_.member(id_).boots != boot_ && (!started || is_after_request(*started));
}

Step SaveRestartJob::wait_for_return(Time now) {
  at_ = At::away;
  const Time next = std::max(sent_at_ + settling_time, now + call_period);
  return dronecan::Pause{.until = std::min(next, sent_at_ + options_.come_back),
                         .ready = [this] { return has_news(); }};
}

/// A servo need not announce by itself that it is back.
Step SaveRestartJob::call(Time now) {
  if (now >= sent_at_ + options_.come_back) {
    has_run_on_ = lives_on();
    return give_up(has_run_on_ ? not_carried_out() : not_back());
  }
  at_ = At::call;
  calls_expected_ = !calls_expected_ && options_.expected && *options_.expected != id_;
  return ask(calls_expected_ ? *options_.expected : id_, GetNodeInfo::type,
             GetNodeInfo::Request{}.encode(),
             {std::min(options_.patience.timeout, sent_at_ + options_.come_back - now), 0});
}

Step SaveRestartJob::judge_call(const Outcome& outcome) {
  const auto info =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  // under another node ID the roster knows it by this response
  if (info && info->unique_id == unique_id_ && !calls_expected_ && !runs_on(*info, outcome.at)) {
    has_restarted_ = true;
  }
  return has_news() ? conclude() : wait_for_return(outcome.at);
}

/// A node ID shared by the servo, now or later, with another unit.
std::optional<dronecan::NodeId> SaveRestartJob::doubled_id() const {
  if (roster_.is_doubled(id_)) {
    return id_;
  }
  const auto& expected = options_.expected;
  const bool is_shared = expected && (roster_.is_doubled(*expected) || is_another_at(*expected));
  return is_shared ? expected : std::nullopt;
}

/// Whether another unit is on the servo's future ID: one that has reported another unique ID since,
/// or has run for longer than the servo can since the request to restart; an earlier holder may
/// have moved away. For a plain restart the future ID is not certain.
bool SaveRestartJob::is_another_at(dronecan::NodeId id) const {
  constexpr Duration tolerance = 1s; // uptime counts whole seconds
  const Member* member = id != id_ ? roster_.find(id) : nullptr;
  const bool is_heard = is_sent_ && member != nullptr && member->last_heard > sent_at_;
  if (options_.kind != RestartKind::save || !is_heard || is_leaving(id)) {
    return false;
  }
  const bool is_too_old = member->status && member->status_at > sent_at_ &&
                          std::chrono::seconds(member->status->uptime_s) >
                              member->status_at - first_sent_at_ + tolerance;
  return (member->is_another_unit(unique_id_) && member->info_at > sent_at_) || is_too_old;
}

/// The servo's node ID after its restart; empty: not back yet. Only its own response counts: a
/// start heard on its ID may be that of another unit.
std::optional<dronecan::NodeId> SaveRestartJob::find_returned(bool must_operate) const {
  for (const auto& [id, member] : roster_.members()) {
    // its ID before earlier restarts is heard no more
    const bool is_restarted =
        id != id_ ? member.last_heard > sent_at_ : has_restarted_ || has_started_anew();
    const bool is_operational = member.status && member.status->mode == dronecan::Mode::operational;
    const bool is_back = member.is_unit(unique_id_) && is_after_request(member.info_start);
    if (is_restarted && is_back && (is_operational || !must_operate)) {
      return id;
    }
  }
  return std::nullopt;
}

Step SaveRestartJob::conclude() {
  if (const auto id = doubled_id()) {
    return give_up(doubled(roster_, *id));
  }
  returned_ = find_returned(true);
  is_over_ = true;
  return std::nullopt;
}

Step SaveRestartJob::give_up(Error error) {
  error_ = std::move(error);
  is_over_ = true;
  return std::nullopt;
}

/// For a servo that goes on running as before.
Error SaveRestartJob::not_carried_out() const {
  const std::uint8_t id = id_.value();
  const std::string_view request = name(options_.kind);
  if (is_confirmed_) {
    return {Code::state, say<texts::did_not_restart>(id, request), say<texts::run_again_hint>(),
            id};
  }
  if (is_refused_) {
    return {Code::refused, say<texts::opcode_refused>(id, request),
            say<texts::opcode_refused_hint>(id), id};
  }
  if (!has_left_) {
    return {Code::no_acknowledge, say<texts::not_sent>(id, request),
            say<texts::nobody_acknowledges_hint>(), id};
  }
  return {Code::timeout, say<texts::opcode_ignored>(id, request), say<texts::no_answer_hint>(), id};
}

/// Whether its last uptime, sent or requested, continues that of before. Being heard proves
/// nothing.
bool SaveRestartJob::lives_on() const {
  const Member* member = roster_.find(id_);
  return member != nullptr && !member->is_another_unit(unique_id_) && !has_restarted_ &&
         !has_started_anew() && member->status && member->status_at > sent_at_ + settling_time &&
         has_run_since(sent_at_, member->status->uptime_s, member->status_at);
}

Error SaveRestartJob::not_back() const {
  const std::uint8_t id = id_.value();
  if (const auto back = find_returned(false)) {
    return {Code::not_back, say<texts::back_not_operational>(back->value()),
            say<texts::not_waited_for_hint>(hex(unique_id_)), id};
  }
  const Member* heard = roster_.find(id_);
  if (heard != nullptr && heard->last_heard > sent_at_ + settling_time &&
      !heard->is_another_unit(unique_id_)) {
    return {Code::not_back, say<texts::heard_not_answering>(id, name(options_.kind)),
            say<texts::no_answer_hint>(), id};
  }
  const bool is_save = options_.kind == RestartKind::save;
  std::string message = is_confirmed_ ? (is_save ? say<texts::saved_not_back>(id)
                                                 : say<texts::restarted_not_back>(id))
                                      : say<texts::unconfirmed_not_back>(id, name(options_.kind));
  if (roster_.is_pending(unique_id_)) {
    return {Code::not_back, std::move(message), say<texts::waits_for_id_hint>(), id};
  }
  const auto waited = fmt::format("{}", std::chrono::duration<double>(options_.come_back).count());
  return {Code::not_back, std::move(message),
          is_save ? say<texts::save_not_back_hint>(waited, hex(unique_id_))
                  : say<texts::not_back_hint>(waited, hex(unique_id_)),
          id};
}

/// It is not waited for any longer, but may still come back.
Error SaveRestartJob::left_waiting() const {
  const std::uint8_t id = id_.value();
  return {Code::interrupted,
          options_.kind == RestartKind::save ? say<texts::save_not_waited_for>(id)
                                             : say<texts::restart_not_waited_for>(id),
          say<texts::not_waited_for_hint>(hex(unique_id_)), id};
}

} // namespace blactl::fleet
