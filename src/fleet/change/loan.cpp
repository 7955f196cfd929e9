#include "blactl/fleet/change/loan.hpp"

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/history.hpp"

#include "fleet/change/texts.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using dronecan::NodeId;

bla::Assignment torque_off(const bla::Profiles& profiles) {
  constexpr std::int64_t off = 1; // 4.13
  bla::Assignment output;
  output.parameter = profiles.find(at::torque_output);
  output.value.raw = off;
  return output;
}

Loan::Loan(Session& session, const bla::Profiles& profiles, bla::Assignment borrowed,
           Change::Options options)
    : session_(session), profiles_(profiles), borrowed_(std::move(borrowed)),
      options_(std::move(options)), change_(session, profiles, options_) {}

std::vector<Error> Loan::prepare(std::span<const NodeId> servos) {
  auto goals = goals_for_all({.assignments = {borrowed_}}, Evidence::none, servos);
  return goals ? change_.prepare(std::move(*goals)) : std::vector{std::move(goals.error())};
}

std::vector<Snapshot> Loan::read(std::span<const NodeId> ids) {
  // every snapshot shows by itself whether the session ended early
  return take_snapshots(session_, profiles_, ids, options_.manner.identification,
                        [this](const Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
                          return servo.identity.registers(std::array{borrowed_.parameter->address});
                        })
      .servos;
}

std::optional<std::int64_t> Loan::value(const Snapshot& snapshot) const {
  return snapshot.raw(borrowed_.parameter->address);
}

std::vector<Error> Loan::look_again() {
  std::vector<NodeId> ids;
  for (const GoalResult& result : change_.results()) {
    ids.push_back(result.servo().id);
  }
  const auto now = read(ids);
  std::vector<Error> errors;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto held = value(now[i]);
    if (auto error = now[i].first_error(); error || !held) {
      errors.push_back(error.value_or(Error{}));
    } else if (held != change_.results()[i].change.changes.front().before) {
      errors.push_back(
          {Code::state,
           say<texts::loan_changed>(ids[i].value(), borrowed_.parameter->name, shown(*held)),
           say<texts::run_again_hint>(), ids[i].value()});
    }
  }
  return errors;
}

std::vector<Error> Loan::take() {
  since_ = session_.now();
  auto errors = change_.carry_out();
  for (const GoalResult& result : change_.results()) {
    const ChangeResult& change = result.change;
    held_.push_back({.servo = result.servo(),
                     .before = change.changes.front().before.value_or(borrowed_.value.raw),
                     .boot = session_.roster().member(result.servo().id).boots,
                     .is_taken = change.was_sent && change.is_done(),
                     .state = change.was_sent ? State::borrowed : State::untouched});
  }
  return errors;
}

std::vector<NodeId> Loan::ids_of(const std::function<bool(const Held& held)>& which) const {
  std::vector<NodeId> ids;
  for (const Held& held : held_) {
    if (which(held)) {
      ids.push_back(held.servo.id);
    }
  }
  std::ranges::sort(ids);
  return ids;
}

std::string Loan::shown(std::int64_t raw) const {
  return bla::input_text(*borrowed_.parameter, raw);
}

std::vector<NodeId> Loan::servos() const {
  return ids_of([](const Held& held) { return held.state == State::borrowed; });
}

std::vector<NodeId> Loan::taken() const {
  return ids_of([](const Held& held) { return held.is_taken; });
}

GivenBack Loan::give_back() {
  const bool was_interrupted = session_.signal() != 0;
  try_to_give_back();
  if (!was_interrupted && session_.signal() != 0) { // which has ended it half way
    try_to_give_back();
  }
  return conclude();
}

GivenBack Loan::give_up() {
  GivenBack given;
  for (const Held& held : held_) {
    (void)tell_unread(held, interrupted_by(session_.signal()), given);
  }
  return given;
}

void Loan::try_to_give_back() {
  std::vector<Held*> all;
  std::vector<NodeId> ids;
  for (Held& held : held_) {
    if (held.state == State::borrowed) {
      all.push_back(&held);
      ids.push_back(held.servo.id);
    }
  }
  const auto now = read(ids);
  std::vector<Goal> goals;
  std::vector<Held*> planned;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i]->error.reset();
    if (auto goal = judge(now[i], *all[i])) {
      goals.push_back(std::move(*goal));
      planned.push_back(all[i]);
    }
  }
  // the record of the loan is taken back; restoring it is not a change of its own
  Change change(session_, profiles_,
                {.manner = {.identification = options_.manner.identification,
                            .while_driven = options_.manner.while_driven},
                 .gives_back = true});
  auto errors = change.prepare(std::move(goals));
  if (errors.empty()) {
    errors = change.carry_out();
  }
  for (std::size_t i = 0; i < planned.size(); ++i) {
    const GoalResult& result = change.results()[i];
    if (result.is_done) {
      planned[i]->state = State::given;
    } else {
      planned[i]->error = !result.errors.empty() ? result.errors.front()
                          : !errors.empty()      ? errors.front()
                                                 : interrupted_by(session_.signal());
    }
  }
}

/// The write needed; empty: none, with the reason in `held`.
std::optional<Goal> Loan::judge(const Snapshot& now, Held& held) const {
  if (auto error = now.first_error()) {
    held.error = std::move(*error);
    return std::nullopt;
  }
  const auto raw = value(now);
  const bool is_ours =
      now.servo.unique_id == held.servo.unique_id && now.servo.boot == held.boot &&
      raw == borrowed_.value.raw &&
      !session_.roster().writer_to(held.servo.id, since_, borrowed_.parameter->address);
  if (raw == held.before || !is_ours) {
    held.state = raw == held.before ? State::given : State::left;
    return std::nullopt;
  }
  bla::Assignment former = borrowed_;
  former.value.raw = held.before;
  return Goal{.id = held.servo.id,
              .unique_id = held.servo.unique_id,
              .wanted = {.assignments = {std::move(former)}}};
}

/// The present values decide, whatever was written, and by whom.
GivenBack Loan::conclude() {
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
  if (History* const history = options_.manner.history; history != nullptr) {
    // on failure undo finds nothing to do
    [[maybe_unused]] const auto forgotten = history->take_back(settled);
  }
  return given;
}

/// Returns false: it is still without its torque.
bool Loan::tell_unread(const Held& held, const Error& why, GivenBack& given) const {
  if (held.state == State::given) { // as shown then
    given.servos.push_back(held.servo.id);
  } else if (held.state != State::untouched) {
    given.errors.push_back(not_given_back(held, held.error.value_or(why)));
  }
  return held.state == State::given;
}

bool Loan::tell(const Held& held, const Snapshot& now, GivenBack& given) const {
  const std::uint8_t id = held.servo.id.value();
  if (now.servo.unique_id != held.servo.unique_id) {
    if (held.state != State::untouched) {
      given.errors.push_back(
          {Code::state, say<texts::loan_of_another>(id), say<texts::loan_of_another_hint>(), id});
    }
    return held.state == State::untouched; // the one that was lent may be away: undo finds it
  }
  const std::int64_t raw = value(now).value_or(borrowed_.value.raw);
  if (auto saved = saved_by_another(held, now)) {
    given.errors.push_back(std::move(*saved));
    return true;
  }
  auto why = what_happened(held, now);
  if (raw == held.before) {
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
               why.value_or(say<texts::loan_is>(id, borrowed_.parameter->name, shown(raw)))};
  given.errors.push_back(
      error_of(held, say<texts::loan_differs>(reason.message, shown(held.before)), reason));
  return is_left || held.state != State::borrowed;
}

/// The value lent may be in ROM: another node ordered SAVE, or a restart brought it back.
std::optional<Error> Loan::saved_by_another(const Held& held, const Snapshot& now) const {
  const std::uint8_t id = held.servo.id.value();
  if (held.state == State::untouched || held.before == borrowed_.value.raw) {
    return std::nullopt;
  }
  const std::string& name = borrowed_.parameter->name;
  const std::string hint = say<texts::loan_rom_back_hint>(name, shown(held.before), id);
  if (const auto by = session_.roster().saver_of(held.servo.id, since_)) {
    return Error{
        Code::state,
        say<texts::loan_saved_by_another>(id, by->value(), name, shown(borrowed_.value.raw)), hint,
        id};
  }
  if (now.servo.boot != held.servo.boot && value(now) == borrowed_.value.raw) {
    return Error{Code::state, say<texts::loan_restarted>(id, name, shown(borrowed_.value.raw)),
                 hint, id};
  }
  return std::nullopt;
}

/// The reason why its torque may not be ours, with its present state.
std::optional<std::string> Loan::what_happened(const Held& held, const Snapshot& now) const {
  const NodeId id = held.servo.id;
  const std::string raw = shown(value(now).value_or(borrowed_.value.raw));
  if (now.servo.boot != held.servo.boot) {
    return say<texts::loan_restarted>(id.value(), borrowed_.parameter->name, raw);
  }
  if (const auto by = session_.roster().writer_to(id, since_, borrowed_.parameter->address)) {
    return say<texts::loan_set_by_another>(id.value(), by->value(), borrowed_.parameter->name, raw);
  }
  return std::nullopt;
}

/// An interruption is reported once, by the command.
Error Loan::not_given_back(const Held& held, const Error& reason) const {
  const bool is_late = reason.code == Code::interrupted;
  return error_of(
      held,
      say<texts::loan_not_back>(held.servo.id.value(),
                                is_late ? say<texts::loan_not_in_time>() : reason.message),
      is_late ? Error{Code::state, {}, {}, {}} : reason);
}

/// Two units on one node ID cannot be commanded: their own hint applies.
Error Loan::error_of(const Held& held, std::string message, const Error& reason) const {
  const std::uint8_t id = held.servo.id.value();
  return {reason.code, std::move(message),
          reason.code == Code::duplicate_node_id
              ? reason.hint
              : say<texts::loan_back_hint>(borrowed_.parameter->name, shown(held.before), id),
          id};
}

} // namespace blactl::fleet
