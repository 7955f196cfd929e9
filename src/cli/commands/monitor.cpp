// blactl monitor: the present state of servos, on a screen or as a stream.

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/monitor/identify.hpp"
#include "cli/monitor/monitor_run.hpp"
#include "cli/monitor/sample.hpp"
#include "cli/monitor/texts.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace blactl::cli {
namespace {

struct MonitorOptions {
  Duration rate = std::chrono::seconds(2); ///< samples per second, stored as seconds
  std::string fields{};                    ///< comma-separated keys; empty: all
  std::optional<Duration> duration{};
  std::optional<std::uint64_t> count{};
  bool identify = false;

  [[nodiscard]] Duration period() const {
    constexpr std::int64_t second = std::chrono::microseconds(std::chrono::seconds(1)).count();
    return Duration(second * second / rate.count());
  }
};

constexpr Option monitor_options[]{
    {.name = "--rate",
     .value = "HZ",
     .kind = Kind::seconds,
     .seconds = {std::chrono::milliseconds(1), std::chrono::seconds(50)},
     .help = {"samples of each servo a second (default 2)",
              "サーボごとの 1 秒あたりのサンプル数 (省略時 2)"},
     .store = into<&MonitorOptions::rate>},
    {.name = "--fields",
     .value = "LIST",
     .kind = Kind::words,
     .repeat = Repeat::list,
     .words = sample_keys,
     .help = {"only these; what is not shown is not asked for",
              "指定した項目のみ (表示しない値は読み出さない)"},
     .store = into<&MonitorOptions::fields>},
    {.name = "--duration",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {std::chrono::milliseconds(1), std::chrono::hours(10'000)},
     .help = {"end after this time", "この時間で終了"},
     .store = into<&MonitorOptions::duration>},
    {.name = "--count",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, ~std::uint64_t{0}},
     .help = {"end after this many samples", "この回数サンプリングしたら終了"},
     .store = into<&MonitorOptions::count>},
    {.name = "--identify",
     .kind = Kind::flag,
     .help =
         {"takes torque off, after a yes: the servo that is turned by hand lights up; in the end "
          "torque comes back",
          "確認後にトルクを OFF にし、手で回したサーボを強調表示。終了時にトルクを元に戻す"},
     .store = into<&MonitorOptions::identify>},
};

/// Errors: usage.
Result<SampleFields> chosen_fields(const MonitorOptions& options) {
  SampleFields fields;
  const auto is_named = [keys = ',' + options.fields + ','](SampleField field) {
    const std::string key(sample_keys[static_cast<std::size_t>(field)]);
    return keys.find(',' + key + ',') != std::string::npos;
  };
  if (is_named(SampleField::moved) && !options.identify) {
    return fail(Code::usage, say<texts::moved_unwatched>(), say<texts::moved_unwatched_hint>());
  }
  std::ranges::copy_if(
      all_sample_fields(options.identify), std::back_inserter(fields),
      [&](SampleField field) { return options.fields.empty() || is_named(field); });
  return fields;
}

bool open(Context& context, Report& report) {
  if (const auto session = context.open(fleet::Session::Hearing::answers); !session) {
    report.fail(session.error());
    return false;
  }
  report.interface = context.session().interface();
  return true;
}

void identify(MonitorManner manner, const fleet::Targets& targets, Context& context,
              Report& report) {
  Identify identified(context, report);
  if (!identified.begin(targets)) {
    identified.end(false);
    for (const Error& error : identified.errors()) {
      report.fail_target(error);
    }
    return report.count_targets();
  }
  manner.holding = identified.holding();
  MonitorRun run(std::move(manner), targets, context, report);
  run.run();
  identified.end(run.was_quit());
  run.conclude(identified.errors());
}

Report execute(const MonitorOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = true};
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  auto targets = context.targets();
  if (!targets) {
    report.fail(targets.error());
    return report;
  }
  auto fields = chosen_fields(options);
  if (!fields) {
    report.fail(fields.error());
    return report;
  }
  MonitorManner manner{.fields = std::move(*fields),
                       .period = options.period(),
                       .duration = options.duration,
                       .count = options.count,
                       .identifies = options.identify};
  context.wait_for_return();
  const Reporter& reporter = context.reporter();
  if (reporter.format() == Format::text && reporter.has_screen()) {
    context.play_at_pace();
  }
  if (options.identify) {
    identify(std::move(manner), *targets, context, report);
  } else if (open(context, report)) {
    MonitorRun run(std::move(manner), std::move(*targets), context, report);
    run.run();
    run.conclude({});
  }
  return report;
}

} // namespace

constinit const Command commands::monitor{
    .name = "monitor",
    .traits = {.streams = true, .tables = true, .session = true, .recordings = true},
    .help = {"live values of servos: a table, graphs, or a stream",
             "サーボの現在値を表 / グラフ / 行形式で表示"},
    .options = monitor_options,
    .action = action<MonitorOptions, execute>,
};

} // namespace blactl::cli
