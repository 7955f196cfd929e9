#include "cli/monitor/identify.hpp"

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

/// The delay between the warning and the torque, if no one is asked.
constexpr Duration warning_time = std::chrono::seconds(2);

} // namespace

bool Identify::begin(fleet::Targets targets) {
  if (!targets.given) {
    targets.given = targets.all = true;
  }
  const bool is_agreed = open("monitor --identify", Recording::if_possible) && select(targets) &&
                         prepare() && confirm() && look_again();
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

/// Errors that end a session end the command; all others concern one servo.
bool Identify::stop_at(std::vector<Error> errors) {
  for (Error& error : errors) {
    if (context_.signal() != 0 || !error.node_id) {
      (void)broken(error);
    } else {
      errors_.push_back(std::move(error));
    }
  }
  return errors.empty();
}

bool Identify::prepare() {
  loan_.emplace(context_.session(), context_.known(), fleet::torque_off(context_.known()),
                fleet::Change::Options{.manner = manner({}, false), .searched = searched_at()});
  if (!stop_at(loan_->prepare(servos_))) {
    return false;
  }
  tell(loan_->change().notes());
  tell_warnings(loan_->change().results());
  return true;
}

bool Identify::confirm() {
  tell_others();
  const std::string changes = loan_->change().question();
  return changes.empty() || WritingRun::confirm(changes + say<texts::identify_question>());
}

/// Repeats the checks, as other nodes may have acted since the confirmation.
bool Identify::look_again() {
  auto errors = loan_->look_again();
  if (context_.signal() != 0) {
    return broken(fleet::interrupted_by(context_.signal()));
  }
  return stop_at(std::move(errors));
}

bool Identify::let_go() {
  context_.session().set_grace(fleet::Session::put_back_grace);
  const auto errors = loan_->take();
  const Reporter& reporter = context_.reporter();
  for (const fleet::GoalResult& result : loan_->change().results()) {
    for (const Error& error : result.errors) {
      if (error.code != Code::interrupted) { // reported once
        reporter.note(error.message);
        errors_.push_back(error);
      }
    }
  }
  if (!stop_at(errors)) {
    return false;
  }
  if (const auto loose = loan_->taken(); !loose.empty()) {
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
  if (!loan_ || loan_->servos().empty()) {
    return;
  }
  if (!warn(may_ask)) {
    return conclude(loan_->give_up());
  }
  conclude(loan_->give_back());
}

/// False: Ctrl-C was pressed a second time.
bool Identify::warn(bool may_ask) {
  fleet::Session& session = context_.session();
  const Reporter& reporter = context_.reporter();
  const bool was_interrupted = session.signal() != 0;
  const auto loose = loan_->servos();
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
