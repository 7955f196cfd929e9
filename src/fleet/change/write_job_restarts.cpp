// What a restart in the middle of writing means for the values written, and for those that were
// held.

#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/write_job.hpp"

#include "fleet/change/texts.hpp"

#include <algorithm>
#include <span>

namespace blactl::fleet {

using dronecan::Outcome;
using dronecan::Step;

namespace {

/// A servo that restarts more often while it is written to does so because of it, or of its supply.
constexpr int most_restarts = 2;

} // namespace

/// The restart has reloaded ROM: the values are to be written again, but with other settings beside
/// them they may mean something else, or be forbidden.
Step WriteJob::check_premises(Time now) {
  const std::uint8_t id = servo_.id.value();
  if (++restarts_ > most_restarts) {
    return give_up(unproven(), {Code::state, say<texts::restarts_again>(id),
                                say<texts::restarts_again_hint>(), id});
  }
  servo_.boot = boots();
  servo_.since = now;
  premise_ = 0;
  return next_premise(now);
}

Step WriteJob::next_premise(Time now) {
  if (premise_ == options_.premises.size()) {
    return write_again(now);
  }
  at_ = At::premise;
  return read_register(servo_.id, options_.premises[premise_].parameter->address,
                       options_.patience);
}

Step WriteJob::judge_premise(const Outcome& outcome) {
  const std::uint8_t id = servo_.id.value();
  const auto& [setting, expected] = options_.premises[premise_];
  const bla::Parameter& parameter = *setting;
  const auto raw = register_value(outcome, servo_.id, parameter.address, parameter.width);
  if (!raw) {
    doubt_unread(parameter, std::nullopt);
    return give_up(unproven(), told_by(raw.error()));
  }
  if (*raw != expected) {
    doubt_unread(parameter, *raw);
    return give_up(unproven(),
                   {Code::state,
                    say<texts::premise_lost>(id, parameter.name, bla::display(parameter, *raw),
                                             bla::display(parameter, expected)),
                    say<texts::run_again_hint>(), id});
  }
  if (servo_.boot != boots()) {
    return prove(outcome.at);
  }
  ++premise_;
  return next_premise(outcome.at);
}

/// Of equal values only those read before this one, which is the last, are known since the restart.
void WriteJob::doubt_unread(const bla::Parameter& last, std::optional<std::int64_t> raw) {
  const auto read = std::span(options_.premises).first(premise_);
  for (RegisterChange& change : changes_) {
    const bool is_known =
        std::ranges::find(read, change.parameter, &Premise::parameter) != read.end();
    if (change.status == ChangeStatus::unchanged && !is_known) {
      const bool is_last = change.parameter == &last && raw;
      change.status = is_last ? ChangeStatus::mismatch : ChangeStatus::failed;
      change.after = is_last ? raw : std::nullopt;
    }
  }
}

Step WriteJob::write_again(Time now) {
  doubted_.reset();
  if (!doubt_unchanged()) {
    return std::nullopt;
  }
  for (RegisterChange& change : changes_) {
    const bool was_refused = change.error && change.after; // what it held then is lost, too
    if (change.status == ChangeStatus::written || was_refused) {
      change.status = ChangeStatus::planned;
      change.error.reset();
    }
  }
  current_ = looked_ = 0;
  return go_on(now);
}

/// A value that was equal in RAM may differ in ROM, if it is no premise; writing it was never
/// agreed to. False: there is nothing left to write.
bool WriteJob::doubt_unchanged() {
  const std::uint8_t id = servo_.id.value();
  for (RegisterChange& change : changes_) {
    const bool is_proven = std::ranges::find(options_.premises, change.parameter,
                                             &Premise::parameter) != options_.premises.end();
    if (change.status == ChangeStatus::unchanged && !is_proven) {
      change.status = ChangeStatus::failed;
      change.after = std::nullopt;
      change.error = Error{Code::state, say<texts::unchanged_no_more>(id, change.parameter->name),
                           say<texts::run_again_hint>(), id};
    }
  }
  return std::ranges::any_of(changes_, [](const RegisterChange& change) {
    return change.is_planned() || change.status == ChangeStatus::written;
  });
}

} // namespace blactl::fleet
