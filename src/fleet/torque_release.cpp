#include "blactl/fleet/torque_release.hpp"

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/guard.hpp"

#include "fleet/torque_texts.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;

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

Wanted TorqueRelease::wanted_back(const Held& held) const {
  return wanted_output(profiles_, held.output);
}

CarriedOut TorqueRelease::let_go(std::span<const Plan> plans, const Manner& manner) {
  auto carried_out = carry_out(session_, profiles_, plans, manner);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto before = plans[i].before.raw(at::torque_output);
    if (carried_out.servos[i].was_sent && before) {
      Servo servo = plans[i].before.servo;
      servo.boot = session_.roster().member(servo.id).boots;
      held_.push_back({.servo = std::move(servo), .output = *before});
    }
  }
  return carried_out;
}

std::vector<dronecan::NodeId> TorqueRelease::servos() const {
  std::vector<dronecan::NodeId> ids;
  for (const Held& held : held_) {
    if (held.state == State::let_go) {
      ids.push_back(held.servo.id);
    }
  }
  std::ranges::sort(ids);
  return ids;
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
  for (Held* held : pending()) {
    held->error = interrupted_by(session_.signal());
  }
  return conclude(nullptr);
}

GivenBack TorqueRelease::conclude(History* history) const {
  GivenBack given;
  std::vector<dronecan::UniqueId> as_before;
  for (const Held& held : held_) {
    if (held.state == State::given) {
      given.servos.push_back(held.servo.id);
    } else if (held.state == State::left) {
      given.notes.push_back(held.note);
    } else if (held.error) {
      given.errors.push_back(not_given_back(held, *held.error));
    }
    if (held.state != State::let_go && held.servo.unique_id) {
      as_before.push_back(*held.servo.unique_id);
    }
  }
  if (history != nullptr) {
    // Else undo finds nothing to do.
    [[maybe_unused]] const auto forgotten = history->take_back(as_before);
  }
  return given;
}

void TorqueRelease::try_to_give_back(bool while_driven) {
  const std::vector<Held*> all = pending();
  std::vector<dronecan::NodeId> ids;
  std::ranges::transform(all, std::back_inserter(ids),
                         [](const Held* held) { return held->servo.id; });
  // Every snapshot tells by itself whether the session ended before it was complete.
  auto snapshots =
      take_snapshots(session_, profiles_, ids, identification_, [this](const Servo& servo) {
        const auto held =
            std::ranges::find(held_, servo.id, [](const Held& each) { return each.servo.id; });
        return registers_needed(wanted_back(*held), servo);
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
  const std::uint8_t id = held.servo.id.value();
  const std::int64_t output = now.raw(at::torque_output).value_or(output_off);
  const auto leave = [&held](std::string note) {
    held.state = State::left;
    held.note = std::move(note);
    return std::nullopt;
  };
  if (now.servo.unique_id != held.servo.unique_id) {
    return leave(say<texts::torque_of_another>(id));
  }
  if (now.servo.boot != held.servo.boot) {
    return leave(say<texts::torque_restarted>(id));
  }
  if (output == held.output) {
    held.state = State::given;
    return std::nullopt;
  }
  if (output != output_off) {
    const bla::Parameter& parameter = *now.servo.identity.parameter(at::torque_output);
    return leave(
        say<texts::torque_set_by_another>(id, parameter.name, bla::input_text(parameter, output)));
  }
  auto plan = make_plan(wanted_back(held), std::move(now), profiles_);
  if (!plan) {
    held.error = std::move(plan.error());
    return std::nullopt;
  }
  held.error = forbidden(session_.roster(), session_.now(), *plan, while_driven);
  return held.error ? std::nullopt : std::optional(std::move(*plan));
}

/// An interruption is told once, by the command.
Error TorqueRelease::not_given_back(const Held& held, const Error& reason) const {
  const bool is_late = reason.code == Code::interrupted;
  const std::uint8_t id = held.servo.id.value();
  const bla::Parameter& parameter = *profiles_.find(at::torque_output);
  return {
      is_late ? Code::state : reason.code,
      say<texts::torque_not_back>(id, is_late ? say<texts::torque_not_in_time>() : reason.message),
      say<texts::torque_back_hint>(parameter.name, bla::input_text(parameter, held.output), id),
      id};
}

} // namespace blactl::fleet
