#include "cli/writing_run.hpp"

#include "blactl/fleet/findings.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/confirm.hpp"
#include "cli/texts.hpp"

#include <utility>

namespace blactl::cli {

bool WritingRun::stop(Error error) {
  report_.fail(std::move(error));
  return false;
}

bool WritingRun::broken(const Error& error) {
  context_.broken(error, report_);
  return false;
}

bool WritingRun::fail(const Error& error, Code refusal) {
  return error.code == refusal ? stop(error) : broken(error);
}

bool WritingRun::open(std::string_view command) {
  if (const auto session = context_.open_for_writing(command); !session) {
    return stop(session.error());
  }
  report_.interface = context_.session().interface();
  return true;
}

std::optional<fleet::Selection>
WritingRun::choose(const fleet::Targets& targets,
                   const fleet::Identification::Options& identification) {
  fleet::Discovery discovery(context_.session(), context_.known(), identification);
  auto selection = discovery.select_for_writing(targets);
  if (!selection) {
    fail(selection.error(), Code::usage);
    return std::nullopt;
  }
  for (const std::string& note : selection->notes) {
    context_.reporter().note(note);
  }
  has_searched_ = targets.need_search();
  chosen_at_ = context_.session().now();
  return std::move(*selection);
}

bool WritingRun::hear() {
  if (const auto heard = fleet::hear_bus(context_.session()); !heard) {
    return fail(heard.error(), Code::state);
  }
  if (!has_searched_) {
    return true;
  }
  const fleet::Roster& roster = context_.session().roster();
  for (const auto& [id, member] : roster.members()) {
    if (member.first_heard > chosen_at_ && member.sends_actuator_status()) {
      report_.fail({Code::state, say<texts::came_since>(id.value()), say<texts::run_again_hint>(),
                    id.value()});
    }
  }
  if (!roster.pending().empty()) {
    context_.reporter().note(say<texts::units_wait_for_id>(roster.pending().size()));
  }
  return report_.errors.empty();
}

void WritingRun::tell(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    if (told_.insert(note).second) {
      context_.reporter().note(note);
    }
  }
}

void WritingRun::tell_others() {
  tell(fleet::notes_before_writing(context_.session().roster()));
}

/// Servos may have moved: who shares a servo ID is not looked at.
void WritingRun::tell_newcomers() {
  tell(fleet::others(context_.session().roster()));
}

bool WritingRun::confirm(const std::string& question) {
  if (question.empty()) {
    return true;
  }
  const auto agreed = cli::confirm(question, context_);
  return agreed || fail(agreed.error(), Code::not_confirmed);
}

void WritingRun::hint_interruption(const std::string& hint) {
  for (Error& error : report_.errors) {
    if (error.code == Code::interrupted) {
      error.hint = hint;
    }
  }
}

} // namespace blactl::cli
