#include "cli/change/writing_run.hpp"

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/characterize/findings.hpp"

#include "cli/change/texts.hpp"
#include "cli/confirm.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/stores.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace blactl::cli {

Error cannot_be_recorded(const Error& reason) {
  return {Code::state, say<texts::state_not_written>(reason.message),
          say<texts::state_not_written_hint>(), std::nullopt};
}

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

bool WritingRun::open(std::string_view command, Recording recording) {
  if (!open_record(command, recording)) {
    return false;
  }
  if (const auto session = context_.open_for_writing(command); !session) {
    return stop(session.error());
  }
  report_.interface = context_.session().interface();
  return true;
}

/// Before the bus is opened: a disk may take longer than the kernel keeps frames. A command that
/// will be refused creates no file.
bool WritingRun::open_record(std::string_view command, Recording recording) {
  recording_ = recording;
  if (recording_ == Recording::none || context_.shared().listen_only ||
      takes_no_frames(context_.shared().interface)) {
    return true;
  }
  const bool writes = recording_ != Recording::looked_up;
  auto history = open_history(context_.shared().interface, command,
                              writes ? state::Access::write : state::Access::read);
  if (history) {
    history_ = std::move(*history);
    return true;
  }
  if (auto refused = writes ? go_unrecorded(history.error()) : std::nullopt) {
    return stop(std::move(*refused));
  }
  return !writes || open_record(command, Recording::looked_up); // it tells what is in RAM only
}

/// The reason why nothing must be changed without a record; empty: it may.
std::optional<Error> WritingRun::go_unrecorded(const Error& reason) {
  if (recording_ == Recording::required) {
    return cannot_be_recorded(reason);
  }
  tell({say<texts::change_not_recorded>(reason.message)});
  return std::nullopt;
}

std::optional<Error> WritingRun::go_without_table(const Error& reason) {
  if (recording_ == Recording::required) {
    return cannot_be_recorded(reason);
  }
  tell({say<texts::ids_not_kept>(reason.message)});
  return std::nullopt;
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
  if (targets.need_search()) {
    searched();
  }
  return std::move(*selection);
}

std::optional<dronecan::NodeId> WritingRun::open_for_one(std::string_view command,
                                                         Recording recording) {
  const auto targets = context_.targets();
  if (!targets) {
    stop(targets.error());
    return std::nullopt;
  }
  auto selection =
      open(command, recording) ? choose(*targets, context_.identification()) : std::nullopt;
  if (!selection) {
    return std::nullopt;
  }
  for (Error& error : selection->errors) {
    report_.fail_target(std::move(error));
  }
  const auto& ids = selection->ids;
  if (report_.targets.empty() && ids.size() != 1) {
    const auto first = ids.empty() ? dronecan::NodeId{} : ids.front();
    stop({Code::usage, say<texts::only_one_servo>(command, ids.size()),
          say<texts::only_one_servo_hint>(command, first.value()), std::nullopt});
  }
  const bool is_one = report_.targets.empty() && ids.size() == 1;
  return is_one ? std::optional(ids.front()) : std::nullopt;
}

void WritingRun::searched() {
  searched_at_ = context_.session().roster().last_heard();
}

bool WritingRun::hear() {
  const auto heard =
      fleet::hear_others(context_.session(), context_.shared().patience, searched_at_);
  tell(heard.notes);
  for (const Error& error : heard.errors) {
    (void)fail(error, Code::state);
  }
  return heard.errors.empty();
}

void WritingRun::tell(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    if (told_.insert(note).second) {
      context_.reporter().note(note);
    }
  }
}

void WritingRun::tell_warnings(std::span<const fleet::GoalResult> results) {
  struct Told {
    std::string_view text;
    std::string ids;
    bool is_of_several = false;
  };

  std::vector<Told> all;
  for (const fleet::GoalResult& result : results) {
    const std::uint8_t id = result.servo().id.value();
    for (const fleet::Warning& warning : result.change.warnings) {
      if (!told_.insert(say<texts::about_node>(id, warning.text)).second) {
        continue;
      }
      const auto same = std::ranges::find(all, warning.text, &Told::text);
      if (same == all.end()) {
        all.push_back({warning.text, std::to_string(id)});
      } else {
        same->ids += ", " + std::to_string(id);
        same->is_of_several = true;
      }
    }
  }
  for (const Told& each : all) {
    context_.reporter().note(each.is_of_several ? say<texts::about_nodes>(each.ids, each.text)
                                                : say<texts::about_node>(each.ids, each.text));
  }
}

void WritingRun::tell_others() {
  tell(fleet::notes_before_writing(context_.session().roster()));
}

/// Servos may have moved, so shared servo IDs are not checked.
void WritingRun::tell_newcomers() {
  tell(fleet::others(context_.session().roster()));
}

fleet::Manner WritingRun::manner(const RestartTimes& times, bool restarts) {
  return {
      .identification = context_.identification(),
      .stagger = times.stagger,
      .come_back = times.wait,
      .overwrite_rom = context_.shared().overwrite_rom,
      .while_driven = context_.shared().while_driven,
      .may_allocate = restarts && context_.may_allocate(),
      .allocations =
          [this] {
            return open_allocations(context_.shared().interface,
                                    state::AllocationStore::Access::write);
          },
      .not_kept = [this](const Error& reason) { return go_without_table(reason); },
      .progress =
          [this](const fleet::Progress& progress) { context_.reporter().progress(text(progress)); },
      .history = recording_ == Recording::looked_up ? nullptr : history(),
      .proofs = history(),
      .not_recorded = [this](const Error& reason) { return go_unrecorded(reason); },
      .end_not_recorded =
          [this](const Error& error) { tell({say<texts::end_not_recorded>(error.message)}); }};
}

bool WritingRun::confirm(const std::string& question, std::string_view option) {
  if (question.empty()) {
    return true;
  }
  const auto agreed = cli::confirm(question, context_, option);
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
