// blactl command: moves the shaft of one servo for a bounded time, and watches it.

#include "blactl/base/replace_file.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/fleet/command_run.hpp"
#include "blactl/fleet/guard.hpp"

#include "cli/command/sample.hpp"
#include "cli/command/svg.hpp"
#include "cli/command/texts.hpp"
#include "cli/commands.hpp"
#include "cli/texts.hpp"
#include "cli/writing_run.hpp"

#include <chrono>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

struct CommandOptions {
  std::string motion{};
  Duration duration = std::chrono::seconds(2);
  bool wiggle = false;
  bool array = false;
  std::string svg{};
};

constexpr std::string_view motions[]{"angle=", "speed=", "torque="};

constexpr Option command_options[]{
    {.name = "--duration",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {std::chrono::milliseconds(1), std::chrono::hours(1)},
     .help = {"for how long it is commanded (default 2)", "指令を継続する時間 (省略時 2 秒)"},
     .store = into<&CommandOptions::duration>},
    {.name = "--wiggle",
     .kind = Kind::flag,
     .help = {"to and fro by 5 deg, to show which servo it is", "±5° の往復動作で対象サーボを確認"},
     .store = into<&CommandOptions::wiggle>},
    {.name = "--array",
     .kind = Kind::flag,
     .help = {"by ArrayCommand to its servo ID, as an autopilot does; only where no other servo "
              "has that ID",
              "オートパイロットと同じくサーボ ID 宛の ArrayCommand で指令 (サーボ ID の重複がない"
              "場合のみ)"},
     .store = into<&CommandOptions::array>},
    {.name = "--svg",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"draws command, angle, speed, torque and limits into FILE, for a browser or a "
              "printer",
              "指令・角度・速度・トルク・制限を FILE に SVG で出力 (ブラウザ表示・印刷用)"},
     .store = into<&CommandOptions::svg>},
};

constexpr Option command_arguments[]{
    {.name = "MOTION",
     .kind = Kind::beginning,
     .words = motions,
     .help = {"what the shaft shall do: angle=45deg, speed=60rpm or torque=20%",
              "動作の指令: angle=45deg、speed=60rpm、torque=20%"},
     .store = into<&CommandOptions::motion>},
};

/// What is commanded; empty: it wiggles. Errors: every fault of the command line.
std::expected<std::optional<bla::Assignment>, std::vector<Error>>
target_of(const CommandOptions& options, const bla::Profiles& profiles) {
  std::vector<Error> faults;
  if (options.svg == "-") {
    faults.push_back(
        {Code::usage, say<texts::motion_svg_to_stdout>(), say<texts::motion_svg_hint>(), {}});
  }
  if (options.motion.empty() != options.wiggle) {
    faults.push_back({Code::usage,
                      options.wiggle ? say<texts::motion_both>(printable(options.motion))
                                     : say<texts::motion_what>(),
                      say<texts::motion_what_hint>(),
                      {}});
    return std::unexpected(std::move(faults));
  }
  std::optional<bla::Assignment> target;
  if (!options.wiggle) {
    const bool is_short = std::ranges::any_of(
        motions, [&](std::string_view word) { return options.motion.starts_with(word); });
    auto typed = bla::parse_assignment(profiles, (is_short ? "command_" : "") + options.motion);
    if (!typed) {
      faults.push_back(std::move(typed.error()));
    } else if (typed->parameter->group != bla::Group::command) {
      faults.push_back({Code::usage,
                        say<texts::motion_no_command>(typed->parameter->name),
                        say<texts::motion_what_hint>(),
                        {}});
    } else {
      target = std::move(*typed);
    }
  }
  if (!faults.empty()) {
    return std::unexpected(std::move(faults));
  }
  return target;
}

/// One run. Each step may end it, with errors in the report.
class MotionRun : WritingRun {
 public:
  MotionRun(const CommandOptions& options, fleet::CommandWanted wanted, Context& context,
            Report& report)
      : WritingRun(context, report), options_(options), wanted_(std::move(wanted)) {}

  void all() {
    const auto may_move = [this] { return prove_servo_id() && check(); };
    if (select() && plan() && hear() && may_move() && confirm() && may_move()) {
      move();
    } else if (report_.signal != 0) {
      hint_interruption(say<texts::nothing_written_hint>());
    }
    report_.count_targets(std::max<std::size_t>(1, report_.targets.size()));
    report_.counts.emplace_back("samples", samples_);
  }

 private:
  bool select();
  bool plan();
  bool prove_servo_id();
  bool check();
  bool confirm();
  void move();
  bool show(const fleet::CommandSample& sample);
  void conclude(const fleet::Commanded& commanded);
  void draw(const fleet::CommandResult& result);

  const CommandOptions& options_;
  fleet::CommandWanted wanted_;
  dronecan::NodeId id_{};
  std::optional<fleet::CommandPlan> plan_;
  std::uint64_t samples_ = 0;
  Time shown_at_{};
};

bool MotionRun::select() {
  const auto targets = context_.targets();
  if (!targets) {
    return stop(targets.error());
  }
  if (!open("command")) {
    return false;
  }
  auto selection = choose(*targets, context_.identification());
  if (!selection) {
    return false;
  }
  for (Error& error : selection->errors) {
    report_.fail_target(std::move(error));
  }
  if (!report_.targets.empty()) {
    return false;
  }
  const auto& ids = selection->ids;
  if (ids.size() != 1) {
    const auto first = ids.empty() ? dronecan::NodeId{} : ids.front();
    return stop({Code::usage, say<texts::motion_one_servo>(ids.size()),
                 say<texts::motion_one_servo_hint>(first.value()), std::nullopt});
  }
  id_ = ids.front();
  return true;
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
  if (!plan) { // two that answer at once answer nothing
    report_.fail_target(roster.is_doubled(id_) ? fleet::doubled(roster, id_)
                                               : std::move(plan.error()));
    return false;
  }
  plan_ = std::move(*plan);
  return true;
}

/// Of each other servo, once more after the question: another one may have come.
bool MotionRun::prove_servo_id() {
  auto refused = wanted_.by_servo_id ? fleet::refuse_servo_id(context_.session(), context_.known(),
                                                              *plan_, context_.identification())
                                     : std::nullopt;
  return !refused || fail(*refused, Code::duplicate_servo_id);
}

/// What the others on the bus forbid; once more after the question, which may take its time.
bool MotionRun::check() {
  if (auto refused = fleet::forbidden(context_.session().roster(), context_.session().now(),
                                      plan_->plan, context_.shared().while_driven)) {
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

/// False: the reader has left, or cannot be written to.
bool MotionRun::show(const fleet::CommandSample& sample) {
  constexpr Duration text_period = std::chrono::milliseconds(100); // what a person can read
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
  const auto printed = reporter.stream(out);
  if (!printed) {
    report_.fail(printed.error());
  }
  return printed.value_or(false);
}

void MotionRun::move() {
  conclude(fleet::command(
      context_.session(), *plan_,
      {.patience = context_.identification().patience,
       .while_driven = context_.shared().while_driven,
       .sampled =
           [this, reads = true](const fleet::CommandSample& sample) mutable {
             reads = reads && show(sample);
             return reads;
           },
       .ending = [this] { context_.reporter().note(say<texts::motion_ending>()); }}));
}

void MotionRun::conclude(const fleet::Commanded& commanded) {
  const fleet::CommandResult& result = commanded.result;
  const bool is_ended = result.has_commanded() && !result.not_ended;
  if (commanded.broken) {
    (void)broken(*commanded.broken);
    hint_interruption(is_ended ? say<texts::motion_interrupted_hint>(fleet::after_commands(*plan_))
                               : say<texts::nothing_written_hint>());
  }
  Target target;
  const bool is_interruption = result.error && result.error->code == Code::interrupted;
  if (result.error && !is_interruption) {
    target.errors.push_back(*result.error);
  }
  if (result.not_ended) {
    target.errors.push_back(*result.not_ended);
  }
  auto differs = !result.error && !result.not_ended && result.has_commanded()
                     ? fleet::judge_motion(*plan_, result)
                     : std::nullopt;
  if (differs) {
    target.errors.push_back(std::move(*differs));
  }
  report_.targets.push_back(std::move(target));
  report_.counts.emplace_back("commands", result.commands);
  if (is_ended) {
    context_.reporter().note(motion_summary(*plan_, result));
  }
  draw(result);
}

void MotionRun::draw(const fleet::CommandResult& result) {
  if (options_.svg.empty() || result.samples.empty()) {
    return;
  }
  const auto written = replace_file(options_.svg, motion_svg(*plan_, result));
  if (!written) {
    return report_.fail(written.error());
  }
  context_.reporter().note(say<texts::motion_drawn>(printable(options_.svg)));
}

Report execute(const CommandOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = true};
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  auto target = target_of(options, **profiles);
  if (!target) { // what every model would refuse: not one frame is sent
    report.errors = std::move(target.error());
    return report;
  }
  const auto drawable = options.svg.empty() ? Result<void>() : check_replaceable(options.svg);
  if (!drawable) {
    report.fail(drawable.error());
    return report;
  }
  MotionRun(
      options,
      {.target = std::move(*target), .duration = options.duration, .by_servo_id = options.array},
      context, report)
      .all();
  return report;
}

} // namespace

constinit const Command commands::command{
    .name = "command",
    .traits = {.writes = true, .streams = true, .tables = true, .session = true},
    .help = {"moves one servo for a bounded time, and shows how it follows",
             "サーボ 1 台を一定時間動作させ、その応答を表示"},
    .options = command_options,
    .arguments = command_arguments,
    .action = action<CommandOptions, execute>,
};

} // namespace blactl::cli
