#include "cli/change_servos.hpp"

#include "blactl/fleet/bus/snapshots.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/change/survey.hpp"

#include "cli/texts.hpp"
#include "cli/writing_run.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using fleet::ChangeResult;
using fleet::Plan;

/// One run. Each step may end it, with errors in the report.
class Run : WritingRun {
 public:
  Run(const ChangeRequest& request, Context& context, Report& report)
      : WritingRun(context, report), request_(request) {}

  void all() {
    if (select() && plan() && hear() && survey() && check() && confirm() && check()) {
      conclude(request_.dry_run ? planned() : carry_out());
    } else if (report_.signal != 0) {
      hint_interruption(say<texts::nothing_written_hint>());
    }
    report_.count_targets(std::max(named_, report_.targets.size()));
  }

 private:
  bool select();
  bool plan();
  bool survey();
  bool check();
  bool confirm();
  [[nodiscard]] std::vector<ChangeResult> planned() const;
  [[nodiscard]] std::vector<ChangeResult> carry_out();
  void conclude(std::vector<ChangeResult> results);

  const ChangeRequest& request_;
  std::vector<dronecan::NodeId> servos_;
  std::size_t named_ = 0; ///< targets, those included that are not there
  std::vector<Plan> plans_;
};

bool Run::select() {
  const auto targets = context_.targets();
  if (!targets) {
    return stop(targets.error());
  }
  if (!open(request_.command, request_.dry_run ? Recording::none : Recording::if_possible)) {
    return false;
  }
  auto selection = choose(*targets, context_.identification());
  if (!selection) {
    return false;
  }
  for (Error& error : selection->errors) {
    report_.fail_target(std::move(error));
  }
  servos_ = std::move(selection->ids);
  named_ = servos_.size() + report_.targets.size();
  if (auto refused = fleet::refuse_together(request_.wanted, servos_)) {
    return stop(std::move(*refused));
  }
  if (auto refused = request_.refuse ? request_.refuse(servos_.size()) : std::nullopt) {
    return stop(std::move(*refused));
  }
  return report_.targets.empty();
}

bool Run::plan() {
  auto snapshots = fleet::take_snapshots(
      context_.session(), context_.known(), servos_, context_.identification(),
      [this](const fleet::Servo& servo) { return fleet::registers_needed(request_.wanted, servo); },
      fleet::proof_needed(request_.wanted));
  if (snapshots.broken) {
    return broken(*snapshots.broken);
  }
  const fleet::Roster& roster = context_.session().roster();
  for (fleet::Snapshot& snapshot : snapshots.servos) {
    const dronecan::NodeId id = snapshot.servo.id;
    auto plan = fleet::make_plan(request_.wanted, std::move(snapshot), context_.known());
    if (plan) {
      plans_.push_back(std::move(*plan));
    } else { // two that answer at once answer nothing
      report_.fail_target(roster.is_doubled(id) ? fleet::doubled(roster, id)
                                                : std::move(plan.error()));
    }
  }
  return report_.targets.empty();
}

/// Who has the IDs that are given.
bool Run::survey() {
  const auto survey =
      fleet::survey(context_.session(), context_.known(), plans_, context_.identification());
  if (!survey) {
    return broken(survey.error());
  }
  for (const dronecan::NodeId id : survey->silent) {
    context_.reporter().note(say<texts::did_not_tell_ids>(id.value()));
  }
  for (const Plan& plan : plans_) {
    if (auto error = fleet::conflict(*survey, plans_, plan)) {
      report_.fail(std::move(*error));
    }
  }
  return report_.errors.empty();
}

/// What the others on the bus forbid; once more after a question, which may take its time.
bool Run::check() {
  for (const Plan& plan : plans_) {
    if (auto error = fleet::forbidden(context_.session().roster(), context_.session().now(), plan,
                                      context_.shared().while_driven)) {
      report_.fail(std::move(*error));
    }
  }
  return report_.errors.empty();
}

bool Run::confirm() {
  tell_others();
  return WritingRun::confirm(request_.dry_run ? std::string() : fleet::question(plans_));
}

std::vector<ChangeResult> Run::planned() const {
  std::vector<ChangeResult> results;
  std::ranges::transform(plans_, std::back_inserter(results), fleet::as_planned);
  return results;
}

std::vector<ChangeResult> Run::carry_out() {
  if (request_.wanted.restart == fleet::RestartKind::save) {
    context_.reporter().note(say<texts::do_not_cut_supply>());
  }
  // A servo that finds its ROM unreadable asks for a node ID as well.
  const auto manner = this->manner(request_.times, request_.wanted.restart.has_value());
  auto carried_out = fleet::carry_out(context_.session(), context_.known(), plans_, manner);
  tell_newcomers();
  if (carried_out.broken) {
    (void)broken(*carried_out.broken);
  }
  return std::move(carried_out.servos);
}

void Run::conclude(std::vector<ChangeResult> results) {
  std::size_t done = 0;
  for (const ChangeResult& result : results) {
    const bool acts =
        result.saves || std::ranges::any_of(result.changes, &fleet::RegisterChange::is_planned);
    const bool would_change = request_.dry_run && acts;
    report_.targets.push_back({.errors = result.errors(), .has_found = would_change});
    done +=
        request_.view == ResultView::servos
            ? static_cast<std::size_t>(result.is_done())
            : static_cast<std::size_t>(std::ranges::count(
                  result.changes, fleet::ChangeStatus::written, &fleet::RegisterChange::status));
  }
  report_.counts = {{request_.view == ResultView::servos ? "done" : "written", done}};
  if (request_.results) {
    request_.results(results);
  }
  const auto kept = std::make_shared<std::vector<ChangeResult>>(std::move(results));
  report_.json = [kept, request = request_](JsonWriter& json) {
    request.json ? request.json(json, *kept) : write_json(json, request.view, *kept);
  };
  report_.text = [kept, request = request_](const Page& page) {
    return request.text ? request.text(*kept, page) : text(request.view, *kept, page);
  };
}

} // namespace

Report change_servos(const ChangeRequest& request, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  if (auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  Run(request, context, report).all();
  return report;
}

} // namespace blactl::cli
