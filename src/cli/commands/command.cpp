// blactl command: moves the shaft of one servo for a limited time, and watches it.

#include "blactl/base/replace_file.hpp"
#include "blactl/bla/assignment.hpp"

#include "cli/commands.hpp"
#include "cli/log_target.hpp"
#include "cli/motion/motion_run.hpp"
#include "cli/motion/texts.hpp"

#include <algorithm>
#include <chrono>
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
     .help = {"for how long it is commanded (default 2)", "指令を継続する時間 (省略時 2)"},
     .store = into<&CommandOptions::duration>},
    {.name = "--wiggle",
     .kind = Kind::flag,
     .help = {"to and fro by 5 deg, to show which servo it is",
              "±5° 以内の往復動作で、どのサーボかを示す"},
     .store = into<&CommandOptions::wiggle>},
    {.name = "--array",
     .kind = Kind::flag,
     .help = {"by ArrayCommand to its servo ID, as an autopilot does; only if no other servo has "
              "that ID",
              "オートパイロットと同じくサーボ ID 宛の ArrayCommand で指令 (サーボ ID の重複がない"
              "場合のみ)"},
     .store = into<&CommandOptions::array>},
    {.name = "--svg",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"draws command, angle, speed, torque and limits into FILE, for a browser or a "
              "printer",
              "指令、角度、速度、トルク、制限のグラフを FILE に SVG で出力 (ブラウザ表示・印刷用)"},
     .store = into<&CommandOptions::svg>},
};

constexpr Option command_arguments[]{
    {.name = "MOTION",
     .kind = Kind::beginning,
     .words = motions,
     .help = {"what the shaft shall do: angle=45deg, speed=60rpm or torque=20%",
              "出力軸の動作: angle=45deg、speed=60rpm、torque=20% のいずれか"},
     .store = into<&CommandOptions::motion>},
};

/// "angle=45deg" is short for command_angle=45deg. Errors: as bla::parse_assignment(); usage, for
/// other registers.
Result<bla::Assignment> parse_motion(const bla::Profiles& profiles, const std::string& text) {
  const auto begins = [&](std::string_view word) {
    return std::ranges::equal(word, text.substr(0, word.size()), {}, {},
                              [](char c) { return c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c; });
  };
  const bool is_short = std::ranges::any_of(motions, begins);
  auto typed = bla::parse_assignment(profiles, (is_short ? "command_" : "") + text);
  if (typed && typed->parameter->group != bla::Group::command) {
    return fail(Code::usage, say<texts::motion_no_command>(typed->parameter->name),
                say<texts::motion_what_hint>());
  }
  if (!typed && !is_short && !text.starts_with("command_")) {
    typed.error().hint = say<texts::motion_what_hint>();
  }
  return typed;
}

/// Errors that do not depend on the servo.
std::vector<Error> faults_of(const CommandOptions& options) {
  std::vector<Error> faults;
  if (options.svg == "-") {
    faults.push_back(
        {Code::usage, say<texts::motion_svg_to_stdout>(), say<texts::motion_svg_hint>(), {}});
  }
  if (options.motion.empty() && !options.wiggle) {
    faults.push_back({Code::usage, say<texts::motion_what>(), say<texts::motion_what_hint>(), {}});
  } else if (!options.motion.empty() && options.wiggle) {
    faults.push_back({Code::usage,
                      say<texts::motion_both>(printable(options.motion)),
                      say<texts::motion_what_hint>(),
                      {}});
  }
  return faults;
}

Report execute(const CommandOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = true};
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  fleet::CommandWanted wanted{.duration = options.duration, .by_servo_id = options.array};
  report.errors = faults_of(options);
  if (!options.motion.empty()) {
    auto target = parse_motion(**profiles, options.motion);
    if (!target) {
      report.fail(target.error());
    } else {
      wanted.target = std::move(*target);
    }
  }
  if (report.errors.empty() && !options.svg.empty()) {
    if (auto drawable = check_target(options.svg, Content::drawing, "--svg"); !drawable) {
      report.fail(drawable.error());
    }
  }
  if (report.errors.empty()) { // otherwise no frame is sent
    MotionRun(std::move(wanted), options.svg, context, report).all();
  }
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
