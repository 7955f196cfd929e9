#include "blactl/fleet/write_job.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/fleet/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Request;

namespace {

/// A servo that restarts more often while it is written to does so because of it, or of its supply.
constexpr int most_restarts = 2;

} // namespace

std::string_view name(ChangeStatus status) {
  switch (status) {
  case ChangeStatus::planned: return "planned";
  case ChangeStatus::unchanged: return "unchanged";
  case ChangeStatus::written: return "written";
  case ChangeStatus::failed: return "failed";
  case ChangeStatus::mismatch: return "mismatch";
  }
  return {};
}

WriteJob::WriteJob(Member& member, std::vector<Change> changes, Patience patience)
    : member_(member), changes_(std::move(changes)), patience_(patience),
      boot_(member.identified_boot) {}

dronecan::Step WriteJob::next(const Outcome& outcome) {
  switch (step_) {
  case Step::begin: return go_on();
  case Step::unique_id:
    if (!same_servo(outcome)) {
      return std::nullopt;
    }
    return go_on();
  case Step::write:
    // Whatever the answer says, or if it was lost: the register itself tells what is true.
    if (outcome.answered() || outcome.kind == Outcome::Kind::timed_out) {
      return read_back();
    }
    give_up(no_answer(outcome, member_.id, changes_[at_].parameter->name));
    return std::nullopt;
  case Step::read:
    judge(outcome);
    if (outcome.kind == Outcome::Kind::cancelled || outcome.kind == Outcome::Kind::not_sent) {
      return std::nullopt;
    }
    ++at_;
    return go_on();
  }
  return std::nullopt;
}

/// The next write, or the unique ID if the servo may be another one.
std::optional<Request> WriteJob::go_on() {
  while (at_ < changes_.size() && changes_[at_].status != ChangeStatus::planned) {
    ++at_;
  }
  const auto concerned = [](const Change& change) {
    return change.status == ChangeStatus::planned || change.status == ChangeStatus::written ||
           change.status == ChangeStatus::unchanged;
  };
  if (boot_ != member_.boots && std::ranges::any_of(changes_, concerned)) {
    step_ = Step::unique_id;
    return ask(member_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
  }
  if (at_ == changes_.size()) {
    return std::nullopt;
  }
  step_ = Step::write;
  return write_register(member_.id, changes_[at_].parameter->address, changes_[at_].requested,
                        patience_);
}

std::optional<Request> WriteJob::read_back() {
  step_ = Step::read;
  return read_register(member_.id, changes_[at_].parameter->address, patience_);
}

/// The restart brought the values of the ROM back: what was written is to be written again.
void WriteJob::begin_again() {
  for (Change& change : changes_) {
    if (change.status == ChangeStatus::written) {
      change.status = ChangeStatus::planned;
    }
  }
  const auto first = std::ranges::find(changes_, ChangeStatus::planned, &Change::status);
  at_ = static_cast<std::size_t>(first - changes_.begin());
}

bool WriteJob::same_servo(const Outcome& outcome) {
  begin_again();
  doubt_unchanged();
  if (!outcome.answered()) {
    give_up(no_answer(outcome, member_.id, "GetNodeInfo"));
    return false;
  }
  const std::uint8_t id = member_.id.value();
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (!info || !member_.info || info->unique_id != member_.info->unique_id) {
    give_up(
        {Code::state, say<texts::restarted_meanwhile>(id), say<texts::node_not_found_hint>(), id});
    return false;
  }
  if (++restarts_ > most_restarts) {
    give_up({Code::state, say<texts::restarts_again>(id), say<texts::restarts_again_hint>(), id});
    return false;
  }
  boot_ = member_.boots;
  return true;
}

/// What was equal in RAM may have another value in ROM. To write it was never agreed.
void WriteJob::doubt_unchanged() {
  const std::uint8_t id = member_.id.value();
  for (Change& change : changes_) {
    if (change.status == ChangeStatus::unchanged) {
      change.status = ChangeStatus::failed;
      change.after = std::nullopt;
      change.error = Error{Code::state, say<texts::unchanged_no_more>(id, change.parameter->name),
                           say<texts::run_again_hint>(), id};
    }
  }
}

void WriteJob::judge(const Outcome& outcome) {
  Change& change = changes_[at_];
  const bla::Parameter& parameter = *change.parameter;
  const std::uint8_t id = member_.id.value();
  const auto raw = register_value(outcome, member_.id, parameter.address);
  if (!raw) {
    change.status = ChangeStatus::failed;
    change.error = raw.error();
    return;
  }
  change.after = parameter.width.narrow(*raw);
  if (*change.after == change.requested) {
    change.status = ChangeStatus::written;
    return;
  }
  const std::string wanted = bla::display(parameter, change.requested);
  const std::string held = bla::display(parameter, *change.after);
  if (change.after == change.before) {
    change.status = ChangeStatus::failed;
    change.error = Error{Code::refused, say<texts::write_refused>(id, parameter.name, wanted, held),
                         say<texts::not_taken_hint>(id), id};
  } else {
    change.status = ChangeStatus::mismatch;
    change.error =
        Error{Code::mismatch, say<texts::write_mismatch>(id, parameter.name, wanted, held),
              say<texts::not_taken_hint>(id), id};
  }
}

/// This change failed, and those behind it are not tried.
void WriteJob::give_up(Error error) {
  // Where nothing is left to write, it is about what was thought to be unchanged.
  Change& change = at_ < changes_.size() ? changes_[at_] : changes_.front();
  change.status = ChangeStatus::failed;
  change.error = std::move(error);
}

} // namespace blactl::fleet
