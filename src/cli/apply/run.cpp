#include "cli/apply/run.hpp"

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/let_in.hpp"

#include "cli/apply/event_file.hpp"
#include "cli/apply/texts.hpp"
#include "cli/apply/view.hpp"
#include "cli/apply/watch.hpp"
#include "cli/texts.hpp"
#include "cli/writing_run.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::Apply;
using fleet::GoalResult;
using state::AllocationStore;

bool may_save(const GoalResult& result) {
  return result.goal.saves && result.need != fleet::Need::nothing;
}

std::vector<dronecan::UniqueId> units_done(std::span<const GoalResult> results) {
  std::vector<dronecan::UniqueId> units;
  for (const GoalResult& result : results) {
    if (result.is_done && result.servo.unique_id) {
      units.push_back(*result.servo.unique_id);
    }
  }
  return units;
}

/// One run. Each step may end it, with errors in the report.
class Run : WritingRun {
 public:
  Run(const ApplyRequest& request, AllocationStore& table, EventFile* events, Context& context,
      Report& report)
      : WritingRun(context, report), request_(request), table_(table), watch_(context, events) {}

  void all();

 private:
  [[nodiscard]] bool look_around();
  [[nodiscard]] bool find();
  [[nodiscard]] bool look_for(const fleet::Targets& targets);
  [[nodiscard]] bool may_let_in();
  [[nodiscard]] bool prepare(Apply& apply);
  [[nodiscard]] bool confirm(const Apply& apply);
  void conclude(const Apply& apply);

  [[nodiscard]] std::optional<bla::Values> proven_rom(const fleet::Servo& servo) {
    return history() != nullptr ? history()->proven_rom(servo, context_.session()) : std::nullopt;
  }

  void tell_counts(std::span<const GoalResult> results);

  /// What ends a session ends the command; anything else is a refusal.
  bool stop_at(const std::vector<Error>& errors) {
    for (const Error& error : errors) {
      context_.signal() != 0 ? context_.broken(error, report_) : report_.fail(error);
    }
    return errors.empty();
  }

  const ApplyRequest& request_;
  AllocationStore& table_;
  ApplyWatch watch_;
  Goals goals_;
};

void Run::all() {
  if (!open(request_.command, request_.dry_run ? Recording::looked_up : request_.recording) ||
      !find()) {
    return;
  }
  auto manner = this->manner(request_.times);
  manner.stops_at_failure = request_.fails_fast;
  manner.entered = [this](const fleet::Servo& servo, fleet::ChangeStage stage) {
    watch_.enter(servo, stage);
  };
  Apply apply(context_.session(), context_.known(), table_,
              {.change = {.manner = std::move(manner),
                          .while_driven = context_.shared().while_driven,
                          .stops_at_failure = request_.fails_fast},
               .trusts_ram = request_.trusts_ram,
               .proven_rom = [this](const fleet::Servo& servo) { return proven_rom(servo); }});
  if (!hear() || !prepare(apply) || !confirm(apply)) {
    if (report_.signal != 0) {
      hint_interruption(say<texts::nothing_written_hint>());
    }
    return;
  }
  if (!request_.dry_run) {
    if (std::ranges::any_of(apply.results(), may_save)) {
      context_.reporter().note(say<texts::do_not_cut_supply>());
    }
    (void)stop_at(apply.carry_out());
    watch_.end(apply.results());
    end_record(units_done(apply.results()));
    if (request_.ended) {
      request_.ended(apply.results());
    }
    tell_newcomers();
  }
  conclude(apply);
}

bool Run::look_around() {
  auto identification = context_.identification();
  identification.static_node_id = true; // who has an ID stands in the way of others
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
  if (!look_around() || !look_for(*targets)) {
    return false;
  }
  if (goals_.may_wait && may_let_in()) {
    if (const auto done = fleet::let_in(context_.session(), table_); !done) {
      return broken(done.error());
    }
    if (!look_around() || !look_for(*targets)) {
      return false;
    }
  }
  return stop_at(goals_.errors);
}

/// Servos that wait for a node ID may be those that are missing. A plan gives none.
bool Run::may_let_in() {
  return !request_.dry_run && !context_.session().roster().pending().empty() &&
         context_.may_allocate();
}

/// What is wished of those that are known by now.
bool Run::look_for(const fleet::Targets& targets) {
  Whom whom{context_.session().roster(), targets};
  if (targets.given || request_.needs_targets) {
    auto selection = choose(targets, context_.identification());
    if (!selection) {
      return false;
    }
    if (!selection->errors.empty()) {
      return stop_at(selection->errors);
    }
    whom.selected = std::move(selection->ids);
  }
  goals_ = request_.find(whom);
  return true;
}

bool Run::prepare(Apply& apply) {
  if (!stop_at(apply.prepare(std::move(goals_.goals))) ||
      (request_.refuse && !stop_at(request_.refuse(apply.results())))) {
    return false;
  }
  watch_.begin(apply.results());
  for (const dronecan::NodeId id : apply.change().silent()) {
    context_.reporter().note(say<texts::did_not_tell_ids>(id.value()));
  }
  for (const fleet::IdMove& move : apply.change().temporary()) {
    context_.reporter().note(say<texts::apply_will_make_way>(move.from.value(), move.to.value()));
  }
  return true;
}

bool Run::confirm(const Apply& apply) {
  tell_others();
  return WritingRun::confirm(request_.dry_run ? std::string() : apply.question());
}

void Run::tell_counts(std::span<const GoalResult> results) {
  std::uint64_t changed = 0, unchanged = 0;
  for (const GoalResult& result : results) {
    const auto status = entry_status(result, request_.dry_run);
    const bool would_change = request_.dry_run && result.need != fleet::Need::nothing;
    report_.targets.push_back(
        {.errors = errors_of(result, request_.dry_run), .has_found = would_change});
    changed += status == fleet::EntryStatus::changed ? 1U : 0U;
    unchanged += status == fleet::EntryStatus::unchanged ? 1U : 0U;
  }
  report_.count_targets();
  report_.counts.emplace_back("changed", changed);
  report_.counts.emplace_back("unchanged", unchanged);
}

void Run::conclude(const Apply& apply) {
  tell_counts(apply.results());
  const auto kept = std::make_shared<std::vector<GoalResult>>(apply.results());
  const auto others = std::make_shared<std::vector<fleet::EntryDiff>>(std::move(goals_.others));
  const bool dry_run = request_.dry_run;
  const std::string asks = dry_run && !apply.question().empty()
                               ? say<texts::apply_would_ask>(apply.question())
                               : std::string();
  report_.json = [=](JsonWriter& json) { write_json(json, *kept, *others, dry_run); };
  report_.text = [=](const Page& page) { return text(*kept, *others, dry_run, page) + asks; };
}

/// The allocation table. Where it cannot be used, and nothing has to be recorded, one that ends
/// with this command: no reason to leave a servo as it is.
Result<AllocationStore> open_table(const ApplyRequest& request, const Context& context) {
  auto table = context.allocations(state::Access::write);
  if (table) {
    return table;
  }
  if (!request.dry_run && request.recording == Recording::required) {
    return std::unexpected(cannot_be_recorded(table.error()));
  }
  context.reporter().note(say<texts::ids_not_kept>(table.error().message));
  return AllocationStore::unshared();
}

} // namespace

Report apply_goals(const ApplyRequest& request, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  auto table = open_table(request, context);
  if (!table) {
    report.fail(table.error());
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
  Run(request, *table, events.get(), context, report).all();
  if (events && events->error()) {
    report.fail(*events->error());
  }
  return report;
}

} // namespace blactl::cli
