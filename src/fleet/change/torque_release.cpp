#include "blactl/fleet/change/torque_release.hpp"

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/snapshots.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/guard.hpp"

#include "fleet/change/torque_texts.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using dronecan::NodeId;

namespace {

constexpr std::int64_t output_off = 1; // 0x20, 4.13

Wanted wanted_output(const bla::Profiles& profiles, std::int64_t raw) {
  bla::Assignment output;
  output.parameter = profiles.find(at::torque_output);
  output.value.raw = raw;
  return {.assignments = {std::move(output)}};
}

} // namespace

Wanted wanted_to_let_go(const bla::Profiles& profiles) {
  return wanted_output(profiles, output_off);
}

/// Only 0x20.
std::vector<Snapshot> TorqueRelease::read(std::span<const dronecan::NodeId> ids) {
  // Every snapshot tells by itself whether the session ended before it was complete.
  return take_snapshots(session_, profiles_, ids, identification_,
                        [](const Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
                          return servo.identity.registers(std::array{at::torque_output});
                        })
      .servos;
}

std::vector<Error> TorqueRelease::look_again(std::span<const Plan> plans) {
  std::vector<NodeId> ids;
  std::ranges::transform(plans, std::back_inserter(ids),
                         [](const Plan& plan) { return plan.before.servo.id; });
  const auto now = read(ids);
  std::vector<Error> errors;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto held = now[i].raw(at::torque_output);
    if (auto error = now[i].first_error(); error || !held) {
      errors.push_back(error.value_or(Error{}));
    } else if (held != plans[i].before.raw(at::torque_output)) {
      errors.push_back({Code::state,
                        say<texts::torque_changed>(ids[i].value(), parameter().name, shown(*held)),
                        say<texts::run_again_hint>(), ids[i].value()});
    }
  }
  return errors;
}

CarriedOut TorqueRelease::let_go(std::span<const Plan> plans, const Manner& manner) {
  since_ = session_.now();
  auto carried_out = carry_out(session_, profiles_, plans, manner);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const Servo& servo = plans[i].before.servo;
    const ChangeResult& result = carried_out.servos[i];
    held_.push_back({.servo = servo,
                     .output = plans[i].before.raw(at::torque_output).value_or(output_off),
                     .boot = session_.roster().member(servo.id).boots,
                     .is_loose = result.was_sent && result.is_done(),
                     .state = result.was_sent ? State::let_go : State::untouched});
  }
  return carried_out;
}

std::vector<NodeId>
TorqueRelease::ids_of(const std::function<bool(const Held& held)>& which) const {
  std::vector<NodeId> ids;
  for (const Held& held : held_) {
    if (which(held)) {
      ids.push_back(held.servo.id);
    }
  }
  std::ranges::sort(ids);
  return ids;
}

/// 0x20, which all models have alike.
const bla::Parameter& TorqueRelease::parameter() const {
  return *profiles_.find(at::torque_output);
}

std::string TorqueRelease::shown(std::int64_t output) const {
  return bla::input_text(parameter(), output);
}

std::vector<NodeId> TorqueRelease::servos() const {
  return ids_of([](const Held& held) { return held.state == State::let_go; });
}

std::vector<NodeId> TorqueRelease::loose() const {
  return ids_of([](const Held& held) { return held.is_loose; });
}

std::vector<TorqueRelease::Held*> TorqueRelease::pending() {
  std::vector<Held*> all;
  for (Held& held : held_) {
    if (held.state == State::let_go) {
      all.push_back(&held);
    }
  }
  return all;
}

GivenBack TorqueRelease::give_back(bool while_driven, History* history) {
  const bool was_interrupted = session_.signal() != 0;
  try_to_give_back(while_driven);
  if (!was_interrupted && session_.signal() != 0) { // which has ended it half way
    try_to_give_back(while_driven);
  }
  return conclude(history);
}

GivenBack TorqueRelease::give_up() {
  GivenBack given;
  for (const Held& held : held_) {
    (void)tell_unread(held, interrupted_by(session_.signal()), given);
  }
  return given;
}

void TorqueRelease::try_to_give_back(bool while_driven) {
  const std::vector<Held*> all = pending();
  std::vector<NodeId> ids;
  std::ranges::transform(all, std::back_inserter(ids),
                         [](const Held* held) { return held->servo.id; });
  auto snapshots = take_snapshots(
      session_, profiles_, ids, identification_,
      [wanted = wanted_to_let_go(profiles_)](const Servo& servo) { // any value of it needs the same
        return registers_needed(wanted, servo);
      });
  std::vector<Plan> plans;
  std::vector<Held*> planned;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i]->error.reset();
    if (auto plan = judge(std::move(snapshots.servos[i]), *all[i], while_driven)) {
      plans.push_back(std::move(*plan));
      planned.push_back(all[i]);
    }
  }
  const auto carried_out =
      carry_out(session_, profiles_, plans, {.identification = identification_});
  for (std::size_t i = 0; i < planned.size(); ++i) {
    const ChangeResult& result = carried_out.servos[i];
    if (result.is_done()) {
      planned[i]->state = State::given;
    } else {
      const auto errors = result.errors();
      planned[i]->error = errors.empty() ? interrupted_by(session_.signal()) : errors.front();
    }
  }
}

/// What is to be written to it; empty: nothing, and `held` says why.
std::optional<Plan> TorqueRelease::judge(Snapshot now, Held& held, bool while_driven) const {
  if (auto error = now.first_error()) {
    held.error = std::move(*error);
    return std::nullopt;
  }
  const auto output = now.raw(at::torque_output);
  const bool is_ours = now.servo.unique_id == held.servo.unique_id && now.servo.boot == held.boot &&
                       output == output_off &&
                       !session_.roster().writer_to(held.servo.id, since_, at::torque_output);
  if (output == held.output || !is_ours) {
    held.state = output == held.output ? State::given : State::left;
    return std::nullopt;
  }
  auto plan = make_plan(wanted_output(profiles_, held.output), std::move(now), profiles_);
  if (!plan) {
    held.error = std::move(plan.error());
    return std::nullopt;
  }
  held.error = forbidden(session_.roster(), session_.now(), *plan, while_driven);
  return held.error ? std::nullopt : std::optional(std::move(*plan));
}

/// What they hold now decides, whatever was written, and by whom.
GivenBack TorqueRelease::conclude(History* history) {
  std::vector<NodeId> ids;
  std::ranges::transform(held_, std::back_inserter(ids),
                         [](const Held& held) { return held.servo.id; });
  const auto now = read(ids);
  GivenBack given;
  std::vector<dronecan::UniqueId> settled;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const auto unread = now[i].first_error();
    const bool is_settled =
        unread ? tell_unread(held_[i], *unread, given) : tell(held_[i], now[i], given);
    if (is_settled && held_[i].servo.unique_id) {
      settled.push_back(*held_[i].servo.unique_id);
    }
  }
  if (history != nullptr) {
    // Else undo finds nothing to do.
    [[maybe_unused]] const auto forgotten = history->take_back(settled);
  }
  return given;
}

/// False: it is still without its torque.
bool TorqueRelease::tell_unread(const Held& held, const Error& why, GivenBack& given) const {
  if (held.state == State::given) { // as it showed then
    given.servos.push_back(held.servo.id);
  } else if (held.state != State::untouched) {
    given.errors.push_back(not_given_back(held, held.error.value_or(why)));
  }
  return held.state == State::given;
}

/// The same.
bool TorqueRelease::tell(const Held& held, const Snapshot& now, GivenBack& given) const {
  const std::uint8_t id = held.servo.id.value();
  if (now.servo.unique_id != held.servo.unique_id) {
    if (held.state != State::untouched) {
      given.errors.push_back({Code::state, say<texts::torque_of_another>(id),
                              say<texts::torque_of_another_hint>(), id});
    }
    return true;
  }
  const std::int64_t output = now.raw(at::torque_output).value_or(output_off);
  auto why = what_happened(held, now);
  if (output == held.output) {
    if (held.state != State::untouched) {
      given.servos.push_back(held.servo.id);
    }
    if (why) {
      given.notes.push_back(std::move(*why));
    }
    return true;
  }
  const bool is_left = why.has_value();
  if (!why && held.error) {
    given.errors.push_back(not_given_back(held, *held.error));
    return false;
  }
  Error reason{Code::state,
               why.value_or(say<texts::torque_is>(id, parameter().name, shown(output)))};
  given.errors.push_back(
      error_of(held, say<texts::torque_differs>(reason.message, shown(held.output)), reason));
  return is_left || held.state != State::let_go;
}

/// Why its torque need not be what we have made it; with what it is.
std::optional<std::string> TorqueRelease::what_happened(const Held& held,
                                                        const Snapshot& now) const {
  const NodeId id = held.servo.id;
  const std::string output = shown(now.raw(at::torque_output).value_or(output_off));
  if (now.servo.boot != held.servo.boot) {
    return say<texts::torque_restarted>(id.value(), parameter().name, output);
  }
  if (const auto by = session_.roster().writer_to(id, since_, at::torque_output)) {
    return say<texts::torque_set_by_another>(id.value(), by->value(), parameter().name, output);
  }
  return std::nullopt;
}

/// An interruption is told once, by the command.
Error TorqueRelease::not_given_back(const Held& held, const Error& reason) const {
  const bool is_late = reason.code == Code::interrupted;
  return error_of(
      held,
      say<texts::torque_not_back>(held.servo.id.value(),
                                  is_late ? say<texts::torque_not_in_time>() : reason.message),
      is_late ? Error{Code::state, {}, {}, {}} : reason);
}

/// Two units on one node ID cannot be told what to do: there its own hint stands.
Error TorqueRelease::error_of(const Held& held, std::string message, const Error& reason) const {
  const std::uint8_t id = held.servo.id.value();
  return {reason.code, std::move(message),
          reason.code == Code::duplicate_node_id
              ? reason.hint
              : say<texts::torque_back_hint>(parameter().name,
                                             bla::input_text(parameter(), held.output), id),
          id};
}

} // namespace blactl::fleet
