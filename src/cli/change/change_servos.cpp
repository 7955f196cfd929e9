#include "cli/change/change_servos.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/ticker.hpp"
#include "blactl/fleet/change/let_in.hpp"

#include "cli/change/entries_view.hpp"
#include "cli/change/event_file.hpp"
#include "cli/change/texts.hpp"
#include "cli/change/watch.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/stores.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::Change;
using fleet::ChangeResult;
using fleet::GoalResult;

bool restarts(const fleet::Goal& goal) {
  return goal.wanted.restart.has_value();
}

bool will_save(const GoalResult& result) {
  return result.goal.saves() && result.need != fleet::Need::nothing;
}

/// With --dry-run: whether something would be sent.
bool would_act(const GoalResult& result) {
  return result.goal.evidence == fleet::Evidence::none
             ? result.change.saves || result.has_differences()
             : result.need != fleet::Need::nothing;
}

std::vector<ChangeResult> changes_of(std::span<const GoalResult> results) {
  std::vector<ChangeResult> changes;
  std::ranges::transform(results, std::back_inserter(changes), &GoalResult::change);
  return changes;
}

/// One run. Each step may end it, with errors in the report.
class Run : WritingRun {
 public:
  Run(const ChangeRequest& request, EventFile* events, Context& context, Report& report)
      : WritingRun(context, report), request_(request), watch_(context, events) {}

  void all();

 private:
  [[nodiscard]] bool check_table();
  [[nodiscard]] bool find();
  [[nodiscard]] bool look_around();
  [[nodiscard]] bool look_for(const fleet::Targets& targets);
  void tell_waiting();
  [[nodiscard]] bool let_in();
  [[nodiscard]] bool may_let_in();
  [[nodiscard]] bool may_be_unheard();
  [[nodiscard]] Change::Options options();
  [[nodiscard]] bool prepare(Change& change);
  [[nodiscard]] bool confirm(const Change& change);
  void stop_before_begin();
  void carry_out(Change& change);
  void tell_held(std::span<const GoalResult> results);
  void conclude(const Change& change);
  void count(std::span<const GoalResult> results);
  void show(const Change& change);
  bool stop_at(const std::vector<Error>& errors);

  const ChangeRequest& request_;
  ApplyWatch watch_;
  fleet::Targets whom_;
  Goals goals_;
  std::size_t named_ = 0; ///< targets, including missing ones
};

void Run::all() {
  if (open(request_.command, request_.dry_run ? Recording::looked_up : request_.recording) &&
      check_table() && find()) {
    Change change(context_.session(), context_.known(), options());
    if (prepare(change) && confirm(change)) {
      request_.dry_run ? conclude(change) : carry_out(change);
      return;
    }
  }
  stop_before_begin();
}

/// Ends the run before anything was written.
void Run::stop_before_begin() {
  if (report_.signal != 0) {
    hint_interruption(say<texts::nothing_written_hint>());
  }
  report_.count_targets(std::max(named_, report_.targets.size()));
}

/// Ends a target with the errors of its servo.
bool Run::stop_at(const std::vector<Error>& errors) {
  for (const Error& error : errors) {
    if (context_.signal() != 0) {
      context_.broken(error, report_);
    } else if (error.node_id) {
      report_.fail_target(error);
    } else {
      report_.fail(error);
    }
  }
  return errors.empty();
}

/// A command that may allocate IDs warns at once if it cannot keep them.
bool Run::check_table() {
  if (request_.search != Search::everybody) {
    return true;
  }
  const auto table = open_allocations(context_.shared().interface, state::Access::write);
  auto refused = table ? std::nullopt : go_without_table(table.error());
  return !refused || stop(std::move(*refused));
}

bool Run::look_around() {
  auto identification = context_.identification();
  identification.static_node_id = true;
  fleet::Discovery discovery(context_.session(), context_.known(), identification);
  if (const auto found = discovery.find_all(fleet::bus_watch_time); !found) {
    return broken(found.error());
  }
  searched();
  return true;
}

bool Run::find() {
  const auto targets = context_.targets();
  if (!targets) {
    return stop(targets.error());
  }
  whom_ = *targets;
  if (request_.search == Search::everybody && !look_around()) {
    return false;
  }
  const bool numbers = (request_.waiting == Waiting::always ||
                        (request_.waiting == Waiting::unless_node_ids && targets->need_search())) &&
                       may_let_in();
  if (numbers && !(let_in() && look_around())) {
    return false;
  }
  if (!look_for(*targets)) {
    return false;
  }
  if (goals_.may_wait && may_be_unheard() && !(look_around() && look_for(*targets))) {
    return false;
  }
  if (goals_.may_wait && may_let_in() && !(let_in() && look_around() && look_for(*targets))) {
    return false;
  }
  tell(goals_.notes);
  if (request_.dry_run && !goals_.errors.empty()) {
    tell_waiting();
  }
  return stop_at(goals_.errors);
}

/// Without a node ID it is not known which of the missing servos they are.
void Run::tell_waiting() {
  std::vector<std::string> notes;
  for (const fleet::UniqueIdPrefix& heard : context_.session().roster().pending()) {
    notes.push_back(say<texts::would_let_in_unknown>(hex(heard)));
  }
  tell(notes);
}

/// Whether missing servos may be waiting for a node ID. A plan allocates none. Who was heard once
/// in so short a time may well be one.
bool Run::may_let_in() {
  const fleet::Roster& roster = context_.session().roster();
  const bool may_wait = request_.waiting == Waiting::if_missing ? !roster.pending().empty()
                                                                : !roster.requests().empty();
  return !request_.dry_run && may_wait && context_.may_allocate();
}

/// Whether servos that wait for a node ID may all have been unheard: each asks once a second, and
/// one request can be lost, or its servo has just been switched on.
bool Run::may_be_unheard() {
  return !request_.dry_run && context_.session().roster().requests().empty() &&
         context_.may_allocate();
}

bool Run::let_in() {
  const Time begin = context_.session().now();
  const fleet::Ticker ticker(context_.session(), std::chrono::seconds(1), [&] {
    context_.reporter().progress(
        say<texts::progress_let_in>(whole_seconds(context_.session().now() - begin)));
  });
  if (request_.let_in) {
    const auto done = request_.let_in();
    return done || broken(done.error());
  }
  auto table = open_allocations(context_.shared().interface, state::Access::write);
  if (!table) {
    context_.reporter().note(say<texts::ids_not_kept>(table.error().message));
    table = state::AllocationStore::unshared();
  }
  const auto asked = table ? fleet::let_in(context_.session(), *table, std::move(goals_.missing))
                           : std::unexpected(table.error());
  if (!asked) {
    return broken(asked.error());
  }
  tell(fleet::taken_over(*asked));
  return true;
}

/// Finds the goals for the servos known so far.
bool Run::look_for(const fleet::Targets& targets) {
  Whom whom{context_.session().roster(), targets};
  if (targets.given || request_.needs_targets) {
    auto selection = choose(targets, context_.identification());
    if (!selection) {
      return false;
    }
    named_ = selection->ids.size() + selection->errors.size();
    if (!selection->errors.empty()) {
      for (Error& error : selection->errors) {
        report_.fail_target(std::move(error));
      }
      return false;
    }
    whom.selected = std::move(selection->ids);
  }
  goals_ = request_.find(whom);
  return true;
}

Change::Options Run::options() {
  auto manner = this->manner(request_.times, std::ranges::any_of(goals_.goals, restarts));
  manner.stops_at_failure = request_.fails_fast;
  if (request_.view == ResultView::entries) {
    manner.entered = [this](const fleet::Servo& servo, fleet::ChangeStage stage) {
      watch_.enter(servo, stage);
    };
  }
  return {.manner = std::move(manner),
          .stops_at_failure = request_.stops_at_failure || request_.fails_fast,
          .knows_ids = request_.search == Search::everybody,
          .searched = searched_at()};
}

bool Run::prepare(Change& change) {
  const auto errors = change.prepare(goals_.goals);
  tell(change.notes());
  if (auto ambiguous = whom_.ambiguity(context_.session().roster(), context_.known())) {
    return stop(std::move(*ambiguous)); // heard since
  }
  if (!stop_at(errors) || (request_.refuse && !stop_at(request_.refuse(change.results())))) {
    return false;
  }
  watch_.begin(change.results());
  tell_warnings(change.results());
  return true;
}

bool Run::confirm(const Change& change) {
  tell_others();
  return WritingRun::confirm(request_.dry_run ? std::string() : change.question(),
                             change.overwrites_rom() ? "--overwrite-rom" : "");
}

/// Notes skipped saves: `saved` is no for a servo that already is as wanted.
void Run::tell_held(std::span<const GoalResult> results) {
  std::vector<std::string> notes;
  for (const GoalResult& result : results) {
    if (result.goal.saves() && result.need == fleet::Need::nothing && result.is_done) {
      notes.push_back(say<texts::held_already>(result.servo().id.value()));
    }
  }
  tell(notes);
}

void Run::carry_out(Change& change) {
  if (std::ranges::any_of(change.results(), will_save)) {
    context_.reporter().note(say<texts::do_not_cut_supply>());
  }
  const auto errors = change.carry_out(request_.moved);
  watch_.end(change.results());
  tell(change.notes());
  tell_warnings(change.results());
  if (request_.view == ResultView::changes) {
    tell_held(change.results());
  }
  tell_newcomers();
  const auto was_begun = [](const GoalResult& result) {
    return result.change.was_begun || result.is_done;
  };
  if (!errors.empty() && std::ranges::none_of(change.results(), was_begun)) {
    (void)stop_at(errors);
    return stop_before_begin();
  }
  for (const Error& error : errors) {
    (void)broken(error);
  }
  conclude(change);
}

void Run::count(std::span<const GoalResult> results) {
  for (const GoalResult& result : results) {
    report_.targets.push_back({.errors = errors_of(result, request_.dry_run),
                               .has_found = request_.dry_run && would_act(result)});
  }
  for (std::size_t i = 0; i < goals_.would_let_in; ++i) {
    report_.targets.push_back({.has_found = true});
  }
  report_.count_targets(std::max(named_, report_.targets.size()));
  std::ranges::copy(counts(request_.view, results, request_.dry_run),
                    std::back_inserter(report_.counts));
}

void Run::conclude(const Change& change) {
  count(change.results());
  if (request_.ended) {
    request_.ended(change.results());
  }
  if (request_.view != ResultView::moves) {
    show(change);
  }
}

void Run::show(const Change& change) {
  const bool dry_run = request_.dry_run;
  const auto kept = std::make_shared<std::vector<GoalResult>>(change.results());
  if (request_.view == ResultView::entries) {
    const auto others = std::make_shared<std::vector<fleet::EntryDiff>>(std::move(goals_.others));
    const std::string asks = dry_run && !change.question().empty()
                                 ? say<texts::apply_would_ask>(change.question())
                                 : std::string();
    report_.json = [=](JsonWriter& json) { write_json(json, *kept, *others, dry_run); };
    report_.text = [=](const Page& page) { return text(*kept, *others, dry_run, page) + asks; };
    return;
  }
  report_.json = [kept, view = request_.view, own = request_.json](JsonWriter& json) {
    const auto changes = changes_of(*kept);
    own ? own(json, changes) : write_json(json, view, changes);
  };
  report_.text = [kept, view = request_.view, own = request_.text](const Page& page) {
    const auto changes = changes_of(*kept);
    return own ? own(changes, page) : text(view, changes, page);
  };
}

} // namespace

ChangeRequest request_for_all(std::string_view command, fleet::Wanted wanted,
                              fleet::Evidence evidence) {
  return {.command = command, .find = [wanted = std::move(wanted), evidence](const Whom& whom) {
            auto goals = fleet::goals_for_all(wanted, evidence, whom.selected);
            return goals ? Goals{.goals = std::move(*goals)} : Goals{.errors = {goals.error()}};
          }};
}

Report change_servos(const ChangeRequest& request, Context& context) {
  Report report{.interface = printable(context.shared().interface),
                .is_stream = request.view == ResultView::moves};
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  std::unique_ptr<EventFile> events;
  if (!request.events.empty()) {
    auto opened = EventFile::open(request.events);
    if (!opened) {
      report.fail(opened.error());
      return report;
    }
    events = std::move(*opened);
  }
  Run(request, events.get(), context, report).all();
  if (events && events->error()) {
    report.fail(*events->error());
  }
  return report;
}

} // namespace blactl::cli
