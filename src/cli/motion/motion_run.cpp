#include "cli/motion/motion_run.hpp"

#include "blactl/base/replace_file.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "cli/motion/sample.hpp"
#include "cli/motion/texts.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

namespace blactl::cli {

MotionRun::MotionRun(fleet::CommandWanted wanted, std::string svg, Context& context, Report& report)
    : WritingRun(context, report), wanted_(std::move(wanted)), svg_(std::move(svg)) {}

void MotionRun::all() {
  const auto may_move = [this] { return prove_servo_id() && check(); };
  if (select() && hear() && plan() && may_move() && confirm() && may_move()) {
    move();
  } else if (report_.signal != 0) {
    hint_interruption(say<texts::nothing_written_hint>());
  }
  report_.count_targets(std::max<std::size_t>(1, report_.targets.size()));
  report_.counts.emplace_back("samples", samples_);
}

bool MotionRun::select() {
  const auto one = open_for_one("command");
  id_ = one.value_or(dronecan::NodeId{});
  return one.has_value();
}

bool MotionRun::plan() {
  auto snapshots = fleet::take_snapshots(
      context_.session(), context_.known(), std::span(&id_, 1), context_.identification(),
      [this](const fleet::Servo& servo) { return fleet::registers_to_command(wanted_, servo); });
  if (snapshots.broken) {
    return broken(*snapshots.broken);
  }
  const fleet::Roster& roster = context_.session().roster();
  auto plan = fleet::plan_command(wanted_, std::move(snapshots.servos.front()), context_.known());
  if (!plan) { // two units that respond at the same time cannot be read
    report_.fail_target(roster.is_doubled(id_) ? fleet::doubled(roster, id_)
                                               : std::move(plan.error()));
    return false;
  }
  plan_ = std::move(*plan);
  return true;
}

/// Checks the servo IDs of the other servos, again after the question: another one may have come.
bool MotionRun::prove_servo_id() {
  auto refused = wanted_.by_servo_id ? fleet::refuse_servo_id(context_.session(), context_.known(),
                                                              *plan_, context_.identification())
                                     : std::nullopt;
  return !refused || fail(*refused, Code::duplicate_servo_id);
}

/// Checks whether other nodes forbid it, again after the question, which may take a while.
bool MotionRun::check() {
  if (auto refused =
          fleet::refuse_to_command(context_.session(), *plan_, context_.shared().while_driven)) {
    report_.fail_target(std::move(*refused));
  }
  return report_.targets.empty();
}

bool MotionRun::confirm() {
  tell_others();
  for (const fleet::Warning& warning : plan_->plan.warnings) {
    context_.reporter().note(warning.text);
  }
  return WritingRun::confirm(fleet::question_to_command(*plan_));
}

/// False: the reader has left, or stdout cannot be written.
bool MotionRun::show(const fleet::MotionSample& sample) {
  constexpr Duration text_period = std::chrono::milliseconds(100); // readable for a person
  const Reporter& reporter = context_.reporter();
  const bool is_first = samples_++ == 0;
  std::string out;
  const fleet::Session& session = context_.session();
  const WallTime wall = session.wall() - (context_.session().now() - sample.at);
  switch (reporter.format()) {
  case Format::json: out = json_motion(wall, *plan_, sample); break;
  case Format::csv:
    out = (is_first ? csv_motion_header(*plan_) : "") + csv_motion(wall, *plan_, sample);
    break;
  case Format::text:
    if (!is_first && sample.at < shown_at_ + text_period) {
      return true;
    }
    shown_at_ = sample.at;
    out = (is_first ? text_motion_header(*plan_) : "") + text_motion(*plan_, sample);
    break;
  }
  unread_ += out;
  while (!unread_.empty() && Reporter::has_room()) { // a slow reader must not delay a command
    const std::size_t line = unread_.find('\n') + 1;
    if (!print(unread_.substr(0, line))) {
      return false;
    }
    unread_.erase(0, line);
  }
  return true;
}

bool MotionRun::print(const std::string& lines) {
  if (has_reader_) {
    const auto printed = context_.reporter().stream(lines);
    if (!printed) {
      report_.fail(printed.error());
    }
    has_reader_ = printed.value_or(false);
  }
  return has_reader_;
}

void MotionRun::move() {
  conclude(fleet::command(
      context_.session(), *plan_,
      {.patience = context_.identification().patience,
       .while_driven = context_.shared().while_driven,
       .sampled = [this](const fleet::MotionSample& sample) { return has_reader_ && show(sample); },
       .ending = [this] { context_.reporter().note(say<texts::motion_ending>()); }}));
}

void MotionRun::conclude(const fleet::Commanded& commanded) {
  const fleet::MotionResult& result = commanded.result;
  if (commanded.broken) {
    (void)broken(*commanded.broken);
    const std::string then = fleet::after_commands(*plan_, result);
    hint_interruption(!result.has_commanded() ? say<texts::nothing_written_hint>()
                      : result.is_ended       ? say<texts::motion_interrupted_hint>(then)
                                              : say<texts::motion_left_hint>(then));
  }
  Target target;
  const bool is_interruption = result.error && result.error->code == Code::interrupted;
  if (result.error && (!is_interruption || result.has_commanded())) {
    target.errors.push_back(*result.error);
  }
  if (auto differs =
          result.is_ended && !result.error ? fleet::judge_motion(*plan_, result) : std::nullopt) {
    target.errors.push_back(std::move(*differs));
  }
  report_.targets.push_back(std::move(target));
  report_.counts.emplace_back("commands", result.commands);
  if (result.is_ended) {
    context_.reporter().note(motion_summary(*plan_, result));
  }
  draw(result);
  (void)print(std::exchange(unread_, {}));
}

void MotionRun::draw(const fleet::MotionResult& result) {
  if (svg_.empty() || result.samples.empty()) {
    return;
  }
  const auto written = replace_file(svg_, motion_svg(*plan_, result));
  if (!written) {
    return report_.fail(written.error());
  }
  context_.reporter().note(say<texts::motion_drawn>(printable(svg_)));
}

} // namespace blactl::cli
