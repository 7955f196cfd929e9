#include "cli/monitor/identify.hpp"

#include "blactl/fleet/bus/snapshots.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/guard.hpp"

#include "cli/confirm.hpp"
#include "cli/monitor/texts.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

namespace blactl::cli {
namespace {

/// Between the warning and the torque, where nobody is asked.
constexpr Duration warning_time = std::chrono::seconds(2);

} // namespace

bool Identify::begin(fleet::Targets targets) {
  if (!targets.given) {
    targets.given = targets.all = true;
  }
  const bool is_agreed = open("monitor --identify", Recording::if_possible) && select(targets) &&
                         plan() && hear() && check() && confirm() && look_again() && check();
  if (!is_agreed && report_.signal != 0) {
    hint_interruption(say<texts::nothing_written_hint>());
  }
  return is_agreed && let_go();
}

bool Identify::select(const fleet::Targets& targets) {
  auto selection = choose(targets, context_.identification());
  if (!selection) {
    return false;
  }
  errors_ = std::move(selection->errors);
  servos_ = std::move(selection->ids);
  return errors_.empty();
}

bool Identify::plan() {
  const fleet::Wanted wanted = fleet::wanted_to_let_go(context_.known());
  auto snapshots = fleet::take_snapshots(
      context_.session(), context_.known(), servos_, context_.identification(),
      [&wanted](const fleet::Servo& servo) { return fleet::registers_needed(wanted, servo); },
      fleet::proof_needed(wanted));
  if (snapshots.broken) {
    return broken(*snapshots.broken);
  }
  const fleet::Roster& roster = context_.session().roster();
  for (fleet::Snapshot& snapshot : snapshots.servos) {
    const dronecan::NodeId id = snapshot.servo.id;
    auto plan = fleet::make_plan(wanted, std::move(snapshot), context_.known());
    if (plan) {
      plans_.push_back(std::move(*plan));
    } else {
      errors_.push_back(roster.is_doubled(id) ? fleet::doubled(roster, id)
                                              : std::move(plan.error()));
    }
  }
  return errors_.empty();
}

bool Identify::check() {
  const fleet::Session& session = context_.session();
  for (const fleet::Plan& plan : plans_) {
    if (auto error = fleet::forbidden(session.roster(), session.now(), plan,
                                      context_.shared().while_driven)) {
      errors_.push_back(std::move(*error));
    }
  }
  return errors_.empty();
}

bool Identify::confirm() {
  tell_others();
  const std::string changes = fleet::question(plans_);
  return changes.empty() || WritingRun::confirm(changes + say<texts::identify_question>());
}

/// What was agreed to is not what another node has made of it meanwhile.
bool Identify::look_again() {
  release_.emplace(context_.session(), context_.known(), context_.identification());
  auto errors = release_->look_again(plans_);
  if (context_.signal() != 0) {
    return broken(fleet::interrupted_by(context_.signal()));
  }
  errors_ = std::move(errors);
  return errors_.empty();
}

bool Identify::let_go() {
  context_.session().set_grace(fleet::Session::put_back_grace);
  const auto carried_out = release_->let_go(plans_, manner({}, false));
  const Reporter& reporter = context_.reporter();
  for (const fleet::ChangeResult& result : carried_out.servos) {
    for (const Error& error : result.errors()) {
      if (error.code != Code::interrupted) { // that is told once
        reporter.note(error.message);
        errors_.push_back(error);
      }
    }
  }
  if (carried_out.broken) {
    return broken(*carried_out.broken);
  }
  if (const auto loose = release_->loose(); !loose.empty()) {
    reporter.note(say<texts::identify_begun>(loose.size(), short_list(loose)));
    return true;
  }
  if (errors_.empty()) {
    reporter.note(say<texts::identify_nothing>());
  }
  return errors_.empty();
}

std::vector<dronecan::NodeId> Identify::holding() const {
  std::vector<dronecan::NodeId> ids;
  for (const Error& error : errors_) {
    if (error.node_id) {
      ids.emplace_back(*error.node_id);
    }
  }
  return ids;
}

void Identify::end(bool may_ask) {
  if (!release_ || release_->servos().empty()) {
    return;
  }
  if (!warn(may_ask)) {
    return conclude(release_->give_up());
  }
  conclude(release_->give_back(context_.shared().while_driven, history()));
}

/// False: somebody has pressed Ctrl-C for the second time.
bool Identify::warn(bool may_ask) {
  fleet::Session& session = context_.session();
  const Reporter& reporter = context_.reporter();
  const bool was_interrupted = session.signal() != 0;
  const auto loose = release_->servos();
  const std::string text = say<texts::identify_back>(loose.size(), short_list(loose));
  if (may_ask && !was_interrupted && Reporter::has_terminal() && !context_.shared().yes) {
    const auto read = wait_for_enter(text + say<texts::identify_enter>(), context_);
    if (!read) {
      (void)broken(read.error());
    }
    return true;
  }
  reporter.ask("blactl: " + text + (was_interrupted ? say<texts::identify_in_time>() : "") + '\n');
  const auto lived = session.live_until(session.now() + warning_time);
  if (!lived && report_.errors.empty()) {
    (void)broken(lived.error());
  }
  return lived || lived.error().code != Code::interrupted || !was_interrupted;
}

void Identify::conclude(fleet::GivenBack given) {
  const Reporter& reporter = context_.reporter();
  for (const std::string& note : given.notes) {
    reporter.note(note);
  }
  if (!given.servos.empty()) {
    std::ranges::sort(given.servos);
    reporter.note(say<texts::identify_done>(given.servos.size(), short_list(given.servos)));
  }
  tell_newcomers();
  if (const int signal = context_.session().signal(); signal != 0 && report_.signal == 0) {
    (void)broken(fleet::interrupted_by(signal));
  }
  hint_interruption(given.errors.empty() ? say<texts::identify_done_hint>()
                                         : say<texts::identify_not_done_hint>());
  errors_.insert(errors_.end(), given.errors.begin(), given.errors.end());
}

} // namespace blactl::cli
