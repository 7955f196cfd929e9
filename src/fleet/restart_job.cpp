#include "blactl/fleet/restart_job.hpp"

#include "blactl/fleet/texts.hpp"

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

/// Uptime counts whole seconds: from this on a restart shows for certain.
constexpr std::uint32_t old_enough_s = 2;

/// How long a servo is given to carry out a request whose answer was lost, before it is asked
/// whether it did. The vendor's updater waits as long (facts, section 6).
constexpr Duration settling_time = 1500ms;

std::string_view name(RestartKind kind) {
  return kind == RestartKind::save ? "SAVE" : "RestartNode";
}

} // namespace

RestartJob::RestartJob(Roster& roster, const Member& servo, Options options)
    : roster_(roster), id_(servo.id), unique_id_(servo.info->unique_id), options_(options) {}

Step RestartJob::next(const Outcome& outcome) {
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
  case At::young: return ask_unit();
  case At::unit: return check_unit(outcome);
  case At::request: return judge_answer(outcome);
  case At::settling:
    if (find_returned() != nullptr) {
      return conclude();
    }
    at_ = At::alive;
    return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
  case At::alive: return judge_life(outcome);
  case At::away: return find_returned() != nullptr ? conclude() : give_up(not_back());
  }
  return std::nullopt;
}

Step RestartJob::ask_unit() {
  at_ = At::unit;
  return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
}

/// It must be the servo that is meant, old enough for its restart to show, and its turn.
Step RestartJob::check_unit(const Outcome& outcome) {
  const std::uint8_t id = id_.value();
  if (!outcome.answered()) {
    return give_up(no_answer(outcome, id_, "GetNodeInfo"));
  }
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (!info || info->unique_id != unique_id_) {
    return give_up({Code::state, say<texts::another_servo>(id), say<texts::run_again_hint>(), id});
  }
  if (info->status.uptime_s < old_enough_s) {
    at_ = At::young;
    return dronecan::Pause{.until = outcome.at +
                                    std::chrono::seconds(old_enough_s - info->status.uptime_s)};
  }
  if (options_.pace != nullptr && outcome.at < options_.pace->next) {
    at_ = At::start;
    return dronecan::Pause{.until = options_.pace->next};
  }
  return request(outcome.at);
}

Step RestartJob::request(Time now) {
  at_ = At::request;
  boot_ = roster_.member(id_).boots;
  sent_at_ = now;
  is_sent_ = true;
  if (options_.pace != nullptr) {
    options_.pace->next = now + options_.pace->distance;
  }
  Patience once = options_.patience;
  once.retries = 0;
  return options_.kind == RestartKind::save
             ? ask(id_, ExecuteOpcode::type,
                   ExecuteOpcode::Request{.opcode = ExecuteOpcode::save}.encode(), once)
             : ask(id_, RestartNode::type, RestartNode::Request{}.encode(), once);
}

bool RestartJob::has_answered_ok(dronecan::Bytes payload) const {
  if (options_.kind == RestartKind::save) {
    const auto response = ExecuteOpcode::Response::decode(payload);
    return response && response->ok;
  }
  const auto response = RestartNode::Response::decode(payload);
  return response && response->ok;
}

Step RestartJob::judge_answer(const Outcome& outcome) {
  if (outcome.answered()) {
    if (!has_answered_ok(outcome.payload)) {
      const std::uint8_t id = id_.value();
      return give_up({Code::refused, say<texts::opcode_refused>(id, name(options_.kind)),
                      say<texts::opcode_refused_hint>(id), id});
    }
    is_confirmed_ = true;
    return wait_for_return();
  }
  if (outcome.kind == Outcome::Kind::not_sent) {
    has_left_ = false; // it may still leave the kernel's queue
  }
  at_ = At::settling;
  return dronecan::Pause{.until = sent_at_ + settling_time,
                         .ready = [this] { return find_returned() != nullptr; }};
}

/// Nobody confirmed the request: what does the servo say of itself?
Step RestartJob::judge_life(const Outcome& outcome) {
  if (find_returned() != nullptr) {
    return conclude();
  }
  const auto info =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  const bool has_not_restarted =
      info && info->unique_id == unique_id_ && roster_.member(id_).boots == boot_;
  if (!has_not_restarted) {
    return wait_for_return();
  }
  if (has_left_ && std::exchange(may_repeat_, false)) {
    return request(outcome.at);
  }
  return give_up(not_carried_out());
}

Step RestartJob::wait_for_return() {
  at_ = At::away;
  return dronecan::Pause{.until = sent_at_ + options_.come_back,
                         .ready = [this] { return find_returned() != nullptr; }};
}

/// The servo after its restart, in operation; null: not yet.
Member* RestartJob::find_returned() const {
  for (auto& [id, member] : roster_.members()) {
    // Where it was before earlier restarts it is heard no more.
    const bool is_restarted = id != id_ ? member.last_heard > sent_at_ : member.boots != boot_;
    // A NodeStatus is news if it came after the answer to GetNodeInfo.
    if (is_restarted && member.is_unit(unique_id_) &&
        (member.info->status.mode == dronecan::Mode::operational ||
         (member.status && member.status_at > sent_at_ &&
          member.status->mode == dronecan::Mode::operational))) {
      return &member;
    }
  }
  return nullptr;
}

Step RestartJob::conclude() {
  returned_ = find_returned();

  is_over_ = true;
  return std::nullopt;
}

Step RestartJob::give_up(Error error) {
  error_ = std::move(error);
  is_over_ = true;
  return std::nullopt;
}

/// Of a servo that lives on as before.
Error RestartJob::not_carried_out() const {
  const std::uint8_t id = id_.value();
  const std::string_view request = name(options_.kind);
  if (is_confirmed_) {
    return {Code::state, say<texts::did_not_restart>(id, request), say<texts::run_again_hint>(),
            id};
  }
  if (!has_left_) {
    return {Code::no_acknowledge, say<texts::not_sent>(id, request),
            say<texts::nobody_acknowledges_hint>(), id};
  }
  return {Code::timeout, say<texts::opcode_ignored>(id, request), say<texts::no_answer_hint>(), id};
}

Error RestartJob::not_back() const {
  const std::uint8_t id = id_.value();
  const Member* before = roster_.find(id_);
  const bool goes_on =
      before != nullptr && before->boots == boot_ && before->last_heard > sent_at_ + settling_time;
  if (goes_on) {
    return not_carried_out();
  }
  const bool is_save = options_.kind == RestartKind::save;
  std::string message = is_confirmed_ ? (is_save ? say<texts::saved_not_back>(id)
                                                 : say<texts::restarted_not_back>(id))
                                      : say<texts::unconfirmed_not_back>(id, name(options_.kind));
  if (roster_.is_pending(unique_id_)) {
    return {Code::not_back, std::move(message), say<texts::waits_for_id_hint>(), id};
  }
  return {Code::not_back, std::move(message), say<texts::not_back_hint>(), id};
}

/// Nobody waits any longer; it may come back all the same.
Error RestartJob::left_waiting() const {
  const std::uint8_t id = id_.value();
  return {Code::interrupted,
          options_.kind == RestartKind::save ? say<texts::save_not_waited_for>(id)
                                             : say<texts::restart_not_waited_for>(id),
          say<texts::not_waited_for_hint>(id), id};
}

} // namespace blactl::fleet
