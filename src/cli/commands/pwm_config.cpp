// blactl pwm-config: 0x34-0x37 as one mapping.

#include "blactl/base/replace_file.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/pwm_mapping.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "cli/change/change_servos.hpp"
#include "cli/commands.hpp"
#include "cli/log_target.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/pwm_view.hpp"
#include "cli/pwm_texts.hpp"
#include "cli/read_servos.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::ChangeResult;

struct PwmOptions {
  std::string neutral{}, range{}, output{}, mode{};
  std::string endpoints{};
  std::optional<std::uint64_t> preset{};
  std::string svg{};
  bool save = false;
  bool dry_run = false;
  RestartTimes times{};

  [[nodiscard]] bool changes() const { return has_parts() || !endpoints.empty() || preset; }

  [[nodiscard]] bool has_parts() const {
    return !neutral.empty() || !range.empty() || !output.empty() || !mode.empty();
  }
};

constexpr std::array<std::string_view, 2> mode_words{"angle", "speed"};

constexpr Option pwm_config_options[]{
    {.name = "--neutral",
     .value = "US",
     .kind = Kind::text,
     .help = {"the pulse that gives 0: 1520us (0x34)", "指令値 0 となるパルス幅: 1520us (0x34)"},
     .store = into<&PwmOptions::neutral>},
    {.name = "--range",
     .value = "US",
     .kind = Kind::text,
     .help = {"how far pulses go to either side: 700us (0x35)",
              "ニュートラルからの片側の入力範囲: 700us (0x35)"},
     .store = into<&PwmOptions::range>},
    {.name = "--output",
     .value = "VALUE",
     .kind = Kind::text,
     .help = {"what the ends of the range give, to either side: 70deg, 150rpm (0x36)",
              "入力範囲の端での指令値 (両側対称): 70deg、150rpm (0x36)"},
     .store = into<&PwmOptions::output>},
    {.name = "--mode",
     .value = "MODE",
     .kind = Kind::suggested,
     .words = mode_words,
     .help = {"angle or speed (0x37), with --output in deg or rpm",
              "angle または speed (0x37)、--output (deg または rpm) と併用"},
     .store = into<&PwmOptions::mode>},
    {.name = "--endpoints",
     .value = "A,B",
     .kind = Kind::text,
     .help = {"neutral, range, output and mode from two points: 500us:-70deg,1500us:70deg",
              "2 点で一括指定: 500us:-70deg,1500us:70deg"},
     .store = into<&PwmOptions::endpoints>},
    {.name = "--preset",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, bla::pwm_presets},
     .help = {"all four by an example of the specification: 1=+-70deg (default of BLA21), "
              "2=+-140deg, 3=500us to 1500us, 4=+-150rpm",
              "仕様書の例で一括指定: 1=±70deg (BLA21 の初期値)、2=±140deg、3=500～1500us、"
              "4=±150rpm"},
     .store = into<&PwmOptions::preset>},
    {.name = "--svg",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"draws the mapping of one servo into FILE, for a browser or a printer",
              "1 台の変換特性を FILE に SVG で出力 (ブラウザ表示・印刷用)"},
     .store = into<&PwmOptions::svg>},
    {.name = "--save",
     .kind = Kind::flag,
     .help = {"then RAM to ROM: restarts the servo, and reads again",
              "続けて RAM を ROM に保存 (サーボの再起動後に再読出し)"},
     .store = into<&PwmOptions::save>},
    {.name = "--dry-run",
     .kind = Kind::flag,
     .help = {"change nothing, show the mapping before and after; exit status 8 when something "
              "would change",
              "変更せず、変更前後の特性を表示 (変更がある場合は終了ステータス 8)"},
     .store = into<&PwmOptions::dry_run>},
    restart_wait<&PwmOptions::times>,
    restart_stagger<&PwmOptions::times>,
};

Error usage(std::string message, std::string hint = {}) {
  return {Code::usage, std::move(message), std::move(hint), std::nullopt};
}

/// A part of the mapping, with its register and its option.
struct Part {
  std::string_view assigned, option, of_endpoints;
};

constexpr std::array<Part, 4> parts{{{"pwm_neutral=", "--neutral ", "--endpoints, neutral "},
                                     {"pwm_range=", "--range ", "--endpoints, range "},
                                     {"pwm_output_range=", "--output ", "--endpoints, output "},
                                     {"pwm_mode=", "--mode ", "--endpoints, mode "}}};

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size()) {
    text.replace(at, what.size(), with);
  }
}

/// Turns an error of an assignment into one of the typed option.
void tell_by_options(Error& error, const PwmOptions& options) {
  for (const Part& part : parts) {
    for (std::string* text : {&error.message, &error.hint}) {
      if (options.has_parts()) {
        replace_all(*text, part.assigned, part.option);
      } else if (!options.endpoints.empty()) {
        replace_all(*text, part.assigned, part.of_endpoints);
      }
    }
  }
}

/// --mode without --output, or with an unknown word.
std::optional<Error> refuse_mode(const PwmOptions& options, const bla::Profiles& profiles) {
  if (options.mode.empty() || !options.output.empty()) {
    return std::nullopt; // the assignment is checked
  }
  const auto mode = bla::parse_assignment(profiles, "pwm_mode=" + options.mode);
  return mode ? usage(say<texts::pwm_mode_needs_output>(printable(options.mode)),
                      say<texts::pwm_mode_hint>())
              : mode.error();
}

/// All contradictions between options.
std::vector<Error> contradictions(const PwmOptions& options, const bla::Profiles& profiles) {
  std::vector<Error> faults;
  const int ways = static_cast<int>(options.has_parts()) +
                   static_cast<int>(!options.endpoints.empty()) +
                   static_cast<int>(options.preset.has_value());
  if (ways > 1) {
    faults.push_back(usage(say<texts::pwm_one_way>(), say<texts::pwm_one_way_hint>()));
  }
  if (auto refused = refuse_mode(options, profiles)) {
    tell_by_options(*refused, options);
    faults.push_back(std::move(*refused));
  }
  if (options.output.find_first_of(",:") != std::string::npos) {
    faults.push_back(usage(say<texts::pwm_output_symmetric>(printable(options.output)),
                           say<texts::pwm_output_hint>()));
  }
  if (options.svg == "-") {
    faults.push_back(usage(say<texts::pwm_svg_to_stdout>(), say<texts::pwm_svg_file_hint>()));
  }
  if (!options.changes() && (options.save || options.dry_run)) {
    faults.push_back(usage(say<texts::pwm_nothing_to_change>(options.save ? "--save" : "--dry-run"),
                           say<texts::pwm_nothing_hint>()));
  }
  return faults;
}

/// The wanted values of 0x34-0x37.
Result<std::vector<std::string>> wanted_values(const PwmOptions& options,
                                               const bla::Profiles& profiles) {
  if (options.preset) {
    return bla::pwm_preset(*options.preset);
  }
  if (!options.endpoints.empty()) {
    return bla::pwm_from_endpoints(profiles, options.endpoints);
  }
  std::vector<std::string> values;
  const std::array typed{&options.neutral, &options.range, &options.output, &options.mode};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!typed.at(i)->empty()) {
      values.push_back(std::string(parts.at(i).assigned) + *typed.at(i));
    }
  }
  return values;
}

/// --svg with several servos: checked before anything is written.
std::optional<Error> refuse_several(const PwmOptions& options, std::size_t servos) {
  return options.svg.empty() || servos <= 1
             ? std::nullopt
             : std::optional(
                   usage(say<texts::pwm_svg_one_servo>(servos), say<texts::pwm_svg_hint>()));
}

/// Draws the mapping of the one servo into the given file.
void draw(const std::string& path, const std::pair<fleet::Servo, bla::Values>& one,
          const Reporter& reporter, Report& report) {
  const auto& [servo, values] = one;
  const auto mapping = bla::pwm_mapping(values);
  if (!mapping) {
    report.fail({Code::state, say<texts::pwm_unknown>(), {}, servo.id.value()});
    return;
  }
  std::string title = head_line(servo);
  title.erase(title.find_last_not_of('\n') + 1);
  if (auto written = replace_file(path, pwm_svg(*mapping, title)); !written) {
    report.fail(written.error());
    return;
  }
  reporter.note(say<texts::pwm_drawn>(printable(path)));
}

/// Errors: unsupported, for a servo without a PWM input.
Result<std::vector<const bla::Parameter*>> registers_of(const fleet::Servo& servo) {
  if (auto possible = servo.identity.check_pwm_input(); !possible) {
    return std::unexpected(possible.error());
  }
  return servo.identity.registers(bla::pwm_registers());
}

/// Such a servo would take the 0 that it holds (table 3-12), which maps nothing.
std::vector<Error> refuse_without_input(std::span<const fleet::GoalResult> planned) {
  std::vector<Error> refused;
  for (const fleet::GoalResult& result : planned) {
    const std::uint8_t id = result.servo().id.value();
    if (const auto possible = result.servo().identity.check_pwm_input(); !possible) {
      const Error& error = possible.error();
      refused.push_back({error.code, say<texts::about_node>(id, error.message), error.hint, id});
    }
  }
  return refused;
}

Report show(const PwmOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto ids = select_for_reading("pwm-config", context, report);
  if (!ids) {
    return report;
  }
  if (auto refused = refuse_several(options, ids->size())) {
    report.fail(std::move(*refused));
    return report;
  }
  auto snapshots = fleet::take_snapshots(context.session(), context.known(), *ids,
                                         context.identification(), registers_of);
  if (snapshots.broken) {
    context.broken(*snapshots.broken, report);
  }
  const auto servos = std::make_shared<std::vector<std::pair<fleet::Servo, bla::Values>>>();
  for (fleet::Snapshot& snapshot : snapshots.servos) {
    const auto id = snapshot.servo.id;
    const bool doubled = context.session().roster().is_doubled(id);
    report.targets.push_back(
        {.errors = doubled ? std::vector{fleet::doubled(context.session().roster(), id)}
                           : snapshot.errors()});
    if (!snapshot.error && !doubled) {
      servos->emplace_back(snapshot.servo, snapshot.values());
    }
  }
  if (!options.svg.empty() && !servos->empty()) {
    draw(options.svg, servos->front(), context.reporter(), report);
  }
  report.count_targets();
  report.json = [servos](JsonWriter& json) {
    json.objects("nodes", *servos, [&](const auto& one) {
      const auto& [servo, values] = one;
      write_head(json, servo);
      write_pwm(json, values);
    });
  };
  report.text = [servos](const Page& page) {
    std::string out;
    for (const auto& [servo, values] : *servos) {
      out += (out.empty() ? "" : "\n") + head_line(servo) + pwm_text(values, page);
    }
    return out;
  };
  return report;
}

void write_changed(JsonWriter& json, std::span<const ChangeResult> results) {
  json.objects("nodes", results, [&](const ChangeResult& result) {
    write_head(json, result.servo);
    write_pwm(json, result.after());
    json.key("before");
    json.begin_object();
    write_pwm(json, result.before);
    json.end_object();
    write_changes(json, result);
  });
}

std::string changed_text(std::span<const ChangeResult> results, const Page& page) {
  std::string out;
  for (const ChangeResult& result : results) {
    out += (out.empty() ? "" : "\n") + changes_text(result, page);
    if (const auto before = bla::pwm_mapping(result.before)) {
      out += page.fit(say<texts::pwm_before>(pwm_summary(*before)));
    }
    out += result.was_begun ? "\n" : say<texts::pwm_after_dry_run>();
    out += pwm_text(result.after(), page);
  }
  return out + saving_text(results, page);
}

Report change(const PwmOptions& options, const bla::Profiles& profiles, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto values = wanted_values(options, profiles);
  if (!values) {
    report.fail(values.error());
    return report;
  }
  auto assignments = bla::parse_assignments(profiles, *values);
  if (!assignments) {
    for (Error& error : assignments.error()) {
      tell_by_options(error, options);
      report.fail(std::move(error));
    }
    return report;
  }
  const auto drawn = std::make_shared<std::vector<std::pair<fleet::Servo, bla::Values>>>();
  auto request = request_for_all(
      "pwm-config",
      {.assignments = std::move(*assignments),
       .restart = options.save ? std::optional(fleet::RestartKind::save) : std::nullopt,
       .also_read = bla::pwm_registers()},
      options.save ? fleet::Evidence::record : fleet::Evidence::none);
  request.find = [&options, find = std::move(request.find)](const Whom& whom) {
    auto refused = refuse_several(options, whom.selected.size());
    return refused ? Goals{.errors = {std::move(*refused)}} : find(whom);
  };
  request.refuse = refuse_without_input;
  request.ended = [drawn](std::span<const fleet::GoalResult> results) {
    for (const fleet::GoalResult& result : results) {
      drawn->emplace_back(result.servo(), result.change.after());
    }
  };
  request.times = options.times;
  request.dry_run = options.dry_run;
  request.view = ResultView::changes;
  request.json = write_changed;
  request.text = changed_text;
  report = change_servos(request, context);
  std::ranges::for_each(report.errors, [&](Error& error) { tell_by_options(error, options); });
  for (Target& target : report.targets) {
    std::ranges::for_each(target.errors, [&](Error& error) { tell_by_options(error, options); });
  }
  if (!options.svg.empty() && !drawn->empty()) {
    draw(options.svg, drawn->front(), context.reporter(), report);
  }
  return report;
}

Report execute(const PwmOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  report.errors = contradictions(options, **profiles);
  if (!report.errors.empty()) {
    return report;
  }
  if (const auto drawable = options.svg.empty()
                                ? Result<void>()
                                : check_target(options.svg, Content::drawing, "--svg");
      !drawable) {
    report.fail(drawable.error());
    return report;
  }
  return options.changes() ? change(options, **profiles, context) : show(options, context);
}

} // namespace

constinit const Command commands::pwm_config{
    .name = "pwm-config",
    .traits = {.session = true, .recordings = true},
    .help = {"how PWM pulses become commands: show, plot, change",
             "PWM 入力と指令値の対応を表示・変更"},
    .options = pwm_config_options,
    .action = action<PwmOptions, execute>,
};

} // namespace blactl::cli
