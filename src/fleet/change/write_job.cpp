#include "blactl/fleet/change/write_job.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/id_texts.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Step;

namespace {

/// Whether the servo is to hold the requested value.
bool is_held(const RegisterChange& change) {
  return change.status == ChangeStatus::written || change.status == ChangeStatus::unchanged;
}

} // namespace

WriteJob::WriteJob(const Roster& roster, Servo servo, std::vector<RegisterChange> changes,
                   Options options)
    : roster_(roster), servo_(std::move(servo)), changes_(std::move(changes)),
      options_(std::move(options)), guard_(roster, options_.may_be_driven, options_.while_driven) {}

Step WriteJob::next(const Outcome& outcome) {
  switch (at_) {
  case At::begin: return begin(outcome.at);
  case At::unit: return judge_unit(outcome);
  case At::write: return after_write(outcome);
  case At::read: return after_read(outcome);
  case At::look: return judge_look(outcome);
  case At::proof: return judge_proof(outcome);
  case At::premise: return judge_premise(outcome);
  }
  return std::nullopt;
}

/// Between reading and writing another unit may have come to the node ID.
Step WriteJob::begin(Time now) {
  begun_ = now;
  if (roster_.is_doubled(servo_.id) ||
      std::ranges::none_of(changes_, &RegisterChange::is_planned)) {
    return go_on(now);
  }
  at_ = At::unit;
  return ask(servo_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
}

Step WriteJob::judge_unit(const Outcome& outcome) {
  const std::uint8_t id = servo_.id.value();
  if (!outcome.answered()) {
    return lose(no_answer(outcome, servo_.id, "GetNodeInfo"));
  }
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (!roster_.is_doubled(servo_.id) && (!info || info->unique_id != servo_.unique_id)) {
    return lose(
        {Code::state, say<texts::another_servo>(id), say<texts::node_not_found_hint>(), id});
  }
  return go_on(outcome.at);
}

bool WriteJob::may_have_changed() const {
  return has_written_ && std::ranges::any_of(changes_, [](const RegisterChange& change) {
           const bool was_refused = change.status == ChangeStatus::failed && change.after &&
                                    change.after == change.before;
           return change.status != ChangeStatus::unchanged && !change.is_planned() && !was_refused;
         });
}

/// Makes the next write; at the end, or after a restart, the proof.
Step WriteJob::go_on(Time now) {
  while (current_ < changes_.size() && !changes_[current_].is_planned()) {
    ++current_;
  }
  if (roster_.is_doubled(servo_.id)) {
    return give_up(unproven(), doubled(roster_, servo_.id));
  }
  const auto concerned = [](const RegisterChange& change) {
    return change.is_planned() || is_held(change);
  };
  if (servo_.boot != boots() && std::ranges::any_of(changes_, concerned)) {
    return prove(now);
  }
  if (current_ == changes_.size()) {
    return next_look(now);
  }
  if (not_any_more()) {
    return hold_off(now);
  }
  at_ = At::write;
  is_lost_ = false;
  // an unheard restart, or another unit on this ID, must be noticed before a repetition
  const Patience once{.timeout = options_.patience.timeout, .retries = 0};
  auto request = guard_.guarded(write_register(servo_.id, changes_[current_].parameter->address,
                                               changes_[current_].requested, once),
                                servo_, next_servo_id());
  request.may_leave = [this, allowed = std::move(request.may_leave)](Time at) {
    return servo_.boot == boots() && !not_any_more() && allowed(at);
  };
  return request;
}

/// Why the next write was right when the plan was made, and is not now: another node has changed
/// what it was judged by, or has given its node ID or servo ID to another servo.
std::optional<Error> WriteJob::not_any_more() const {
  const std::uint8_t id = servo_.id.value();
  const RegisterChange& change = changes_[current_];
  const bool gives_id = change.parameter->address == bla::address::static_node_id &&
                        change.requested > 0 && change.requested <= dronecan::NodeId::max;
  if (gives_id && is_taken(dronecan::NodeId(static_cast<std::uint8_t>(change.requested)))) {
    return Error{Code::duplicate_node_id, say<texts::id_given_is_kept>(id, change.requested),
                 say<texts::id_given_is_kept_hint>(), id};
  }
  const auto servo_id = next_servo_id().value_or(0);
  const auto holder = servo_id != 0
                          ? roster_.giver_of_servo_id(servo_id, servo_.id,
                                                      std::min(servo_.since, options_.surveyed))
                          : std::nullopt;
  if (holder) {
    return Error{Code::duplicate_servo_id,
                 say<texts::servo_id_given_is_taken>(id, servo_id, holder->value()),
                 say<texts::servo_id_taken_hint>(), id};
  }
  for (const Premise& premise : options_.premises) {
    if (const auto writer =
            roster_.setter_of(servo_.id, servo_.since, premise.parameter->address)) {
      return Error{Code::state,
                   say<texts::judged_by_changed>(id, change.parameter->name, writer->value(),
                                                 premise.parameter->name),
                   say<texts::run_again_hint>(), id};
    }
  }
  return std::nullopt;
}

/// Whether a node ID that was free is another's meanwhile: given to it, or heard from it.
bool WriteJob::is_taken(dronecan::NodeId given) const {
  const bool is_heard = given != servo_.id && roster_.heard(given) &&
                        roster_.member(given).last_heard > begun_ &&
                        !roster_.has_moved(roster_.member(given));
  return is_heard || roster_.giver_of(given, servo_.id, servo_.since);
}

/// If the next write gives it one.
std::optional<std::int64_t> WriteJob::next_servo_id() const {
  const RegisterChange& change = changes_[current_];
  return change.parameter->address == bla::address::servo_id ? std::optional(change.requested)
                                                             : std::nullopt;
}

/// To the next change.
void WriteJob::move_on() {
  ++current_;
  tries_ = 0;
}

Step WriteJob::after_write(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::withheld) {
    return hold_off(outcome.at);
  }
  has_written_ = true;
  if (!outcome.answered() && outcome.kind != Outcome::Kind::timed_out) {
    return give_up(current_, no_answer(outcome, servo_.id, changes_[current_].parameter->name));
  }
  RegisterChange& change = changes_[current_];
  const bla::Parameter& parameter = *change.parameter;
  const auto echo = register_value(outcome, servo_.id, parameter.address, parameter.width);
  if (echo == change.requested) {
    return wrote(outcome.at);
  }
  // whatever the response, or if it was lost: reading the register shows its value
  is_lost_ = !outcome.answered();
  at_ = At::read;
  return read_register(servo_.id, parameter.address, options_.patience);
}

/// Does not make this change and those after it.
Step WriteJob::hold_off(Time now) {
  RegisterChange& change = changes_[current_];
  auto why = guard_.forbids(servo_, now, next_servo_id());
  why = why ? why : not_any_more();
  if (!why) { // it has restarted, or what forbade it has ended
    return go_on(now);
  }
  change.status = ChangeStatus::failed;
  change.error = std::move(why);
  current_ = changes_.size();
  return next_look(now);
}

Step WriteJob::wrote(Time now) {
  take_written();
  return go_on(now);
}

/// The register holds the requested value.
void WriteJob::take_written() {
  RegisterChange& change = changes_[current_];
  change.after = change.requested;
  change.status = ChangeStatus::written;
  if (change.parameter->address == bla::address::servo_id) {
    servo_.servo_id = change.requested; // it may obey commands to this one from now on
  }
  move_on();
}

Step WriteJob::after_read(const Outcome& outcome) {
  RegisterChange& change = changes_[current_];
  const bla::Parameter& parameter = *change.parameter;
  const auto raw = register_value(outcome, servo_.id, parameter.address, parameter.width);
  if (outcome.kind == Outcome::Kind::cancelled || outcome.kind == Outcome::Kind::not_sent) {
    return give_up(current_, raw.error());
  }
  if (!raw) {
    change.status = ChangeStatus::failed;
    change.error = raw.error();
    move_on();
    return go_on(outcome.at);
  }
  if (*raw == change.requested && !is_lost_) {
    return wrote(outcome.at);
  }
  change.after = *raw;
  return doubt(current_, outcome.at);
}

/// A restart between the write and the response looks the same, and so may another unit.
Step WriteJob::doubt(std::size_t change, Time now) {
  doubted_ = change;
  return prove(now);
}

/// Reads what was written, and what was held already, as another write may have changed it; at the
/// end, the proof.
Step WriteJob::next_look(Time now) {
  const bool looks = options_.echo == Echo::is_checked && has_written_;
  while (looked_ < changes_.size() && (!looks || !is_held(changes_[looked_]))) {
    ++looked_;
  }
  if (looked_ == changes_.size()) {
    return std::ranges::any_of(changes_, is_held) ? prove(now) : Step(std::nullopt);
  }
  at_ = At::look;
  return read_register(servo_.id, changes_[looked_].parameter->address, options_.patience);
}

Step WriteJob::judge_look(const Outcome& outcome) {
  RegisterChange& change = changes_[looked_];
  const auto raw =
      register_value(outcome, servo_.id, change.parameter->address, change.parameter->width);
  if (outcome.kind == Outcome::Kind::cancelled || outcome.kind == Outcome::Kind::not_sent) {
    return give_up(looked_, raw.error());
  }
  if (!raw) {
    change.status = ChangeStatus::failed;
    change.after = std::nullopt;
    change.error = raw.error();
  } else if (*raw != change.requested) {
    change.after = *raw;
    is_lost_ = false;
    return doubt(looked_, outcome.at);
  }
  ++looked_;
  return next_look(outcome.at);
}

Step WriteJob::prove(Time now) {
  at_ = At::proof;
  run_proof_.emplace(roster_, servo_, servo_.since, options_.patience);
  return run_proof_->next({Outcome::Kind::start, {}, now});
}

Step WriteJob::judge_proof(const Outcome& outcome) {
  if (Step step = run_proof_->next(outcome); !step.is_end()) {
    return step;
  }
  const std::uint8_t id = servo_.id.value();
  switch (run_proof_->verdict()) {
  case RunProof::Verdict::failed: return lose(told_by(*run_proof_->error()));
  case RunProof::Verdict::restarted: return check_premises(outcome.at);
  case RunProof::Verdict::too_late:
    return give_up(unproven(), {Code::state, say<texts::written_too_late>(id),
                                say<texts::run_again_hint>(), id});
  case RunProof::Verdict::ran_on: break;
  }
  if (!doubted_) {
    return std::nullopt;
  }
  const std::size_t doubted = *std::exchange(doubted_, std::nullopt);
  if (changes_[doubted].after == changes_[doubted].requested) {
    take_written();
  } else if (changes_[doubted].status == ChangeStatus::unchanged) {
    write_after_others(doubted);
  } else if (!may_try_again()) {
    judge(changes_[doubted]);
    if (current_ == doubted) {
      move_on();
    }
  }
  return go_on(outcome.at);
}

/// One of the writes has changed a value that was held already.
void WriteJob::write_after_others(std::size_t change) {
  changes_[change].status = ChangeStatus::planned;
  current_ = change;
  tries_ = 0;
  looked_ = 0;
}

/// A write that was lost, now that the servo is known to have run on.
bool WriteJob::may_try_again() {
  return is_lost_ && changes_[current_].after == changes_[current_].before &&
         tries_++ < options_.patience.retries;
}

/// A servo that has been written to is in doubt.
Error WriteJob::told_by(const Error& error) const {
  const std::uint8_t id = servo_.id.value();
  if (has_written_ && error.code == Code::timeout) {
    return {Code::timeout, say<texts::not_proven_any_more>(id), say<texts::no_answer_hint>(), id};
  }
  if (has_written_ && error.code == Code::state) {
    return {Code::state, say<texts::written_to_another>(id), say<texts::node_not_found_hint>(), id};
  }
  return error;
}

/// No restart explains why the register differs.
void WriteJob::judge(RegisterChange& change) const {
  const bla::Parameter& parameter = *change.parameter;
  const std::uint8_t id = servo_.id.value();
  const std::string wanted = bla::display(parameter, change.requested);
  const std::string held = bla::display(parameter, *change.after);
  const bool is_as_before = change.after == change.before;
  change.status = is_as_before ? ChangeStatus::failed : ChangeStatus::mismatch;
  if (is_as_before && is_lost_) {
    change.error = Error{Code::timeout, say<texts::write_lost>(id, parameter.name, wanted, held),
                         say<texts::no_answer_hint>(), id};
  } else if (is_as_before) {
    change.error = Error{Code::refused, say<texts::write_refused>(id, parameter.name, wanted, held),
                         say<texts::not_taken_hint>(id), id};
  } else {
    change.error =
        Error{Code::mismatch, say<texts::write_mismatch>(id, parameter.name, wanted, held),
              say<texts::not_taken_hint>(id), id};
  }
}

/// The index of the change that gets the error if the servo is not proven to be the same: the one
/// in doubt, else the first written, else the next one, else the first.
std::size_t WriteJob::unproven() const {
  const auto first = [this](ChangeStatus status) {
    const auto it = std::ranges::find(changes_, status, &RegisterChange::status);
    return static_cast<std::size_t>(it - changes_.begin());
  };
  const std::size_t made = doubted_ ? *doubted_ : first(ChangeStatus::written);
  const std::size_t next = made < changes_.size() ? made : current_;
  const std::size_t held = next < changes_.size() ? next : first(ChangeStatus::unchanged);
  return held < changes_.size() ? held : 0;
}

/// The servo is not there any more: what it held already is not known, either.
Step WriteJob::lose(Error error) {
  const std::size_t blamed = unproven();
  if (error.code != Code::interrupted) {
    for (RegisterChange& change : changes_) {
      if (change.status == ChangeStatus::unchanged) {
        change.status = ChangeStatus::failed;
        change.after = std::nullopt;
      }
    }
  }
  return give_up(blamed, std::move(error));
}

/// This change failed, the remaining ones are not tried, and earlier writes are not proven.
Step WriteJob::give_up(std::size_t blamed, Error error) {
  for (RegisterChange& change : changes_) {
    if (change.status == ChangeStatus::written) {
      change.status = ChangeStatus::failed;
      change.after = std::nullopt;
    }
  }
  if (blamed < changes_.size()) {
    RegisterChange& change = changes_[blamed];
    const bool was_read = change.status == ChangeStatus::mismatch && !change.error;
    if (!was_read) {
      change.status = ChangeStatus::failed;
      change.after = std::nullopt;
    }
    change.error = std::move(error);
  }
  return std::nullopt;
}

} // namespace blactl::fleet
