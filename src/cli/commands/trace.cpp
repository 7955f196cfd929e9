// blactl trace: every DroneCAN transfer decoded, live or from a log.

#include "blactl/can/log_reader.hpp"
#include "blactl/can/replay_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include "cli/commands.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/texts.hpp"
#include "cli/trace/stats.hpp"
#include "cli/trace/texts.hpp"
#include "cli/trace/trace_run.hpp"
#include "cli/trace/tracer.hpp"

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace blactl::cli {
namespace {

struct TraceOptions {
  std::string file{}; ///< a log, or "-"; empty: the interface
  TraceFilter::Wish filter{};
  std::optional<Duration> duration{};
  std::optional<std::uint64_t> count{};
  bool stats = false;
  bool absolute = false;
};

constexpr std::array<std::string_view, 3> kinds{"message", "request", "response"};

constexpr Option trace_options[]{
    {.name = "--type",
     .value = "T",
     .kind = Kind::data_types,
     .repeat = Repeat::list,
     .help = {"only these data types: NodeStatus, param.GetSet, 341",
              "指定したデータ型のみ: NodeStatus、param.GetSet、341"},
     .store = into<&TraceOptions::filter, &TraceFilter::Wish::types>},
    {.name = "--kind",
     .value = "K",
     .kind = Kind::words,
     .repeat = Repeat::list,
     .words = kinds,
     .help = {"only these kinds", "指定した種別のみ"},
     .store = into<&TraceOptions::filter, &TraceFilter::Wish::kinds>},
    {.name = "--duration",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {std::chrono::milliseconds(1), std::chrono::hours(24)},
     .help = {"how long to listen; of a log its first seconds",
              "受信する時間 (ログでは先頭からの秒数)"},
     .store = into<&TraceOptions::duration>},
    {.name = "--count",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, ~std::uint64_t{0}},
     .help = {"end after this many transfers", "この数の転送で終了"},
     .store = into<&TraceOptions::count>},
    {.name = "--stats",
     .kind = Kind::flag,
     .help =
         {"instead of the transfers: who sends what how often, what is lost, the load of the bus",
          "個々の転送の代わりに、送信元・データ型ごとの頻度・周期・欠落とバス負荷を表示"},
     .store = into<&TraceOptions::stats>},
    {.name = "--absolute",
     .kind = Kind::flag,
     .help = {"the time of day instead of seconds since the first frame",
              "最初のフレームからの秒数の代わりに日時を表示"},
     .store = into<&TraceOptions::absolute>},
};

constexpr Option trace_arguments[]{
    {.name = "FILE",
     .kind = Kind::file,
     .help = {"a log of candump -l, Vector (ASC) or PEAK (TRC), plain or .gz, or - (default: the "
              "interface)",
              "candump -l、Vector (ASC)、PEAK (TRC) のログ (.gz 可)、または - (省略時: "
              "インターフェース)"},
     .store = into<&TraceOptions::file>},
};

/// The log to read; empty: an interface is used.
std::optional<std::string> log_path(const TraceOptions& options, const std::string& interface) {
  if (!options.file.empty()) {
    return options.file;
  }
  const auto name = parse_interface(interface);
  return name && name->is(Behind::log) ? std::optional(name->rest) : std::nullopt;
}

Result<std::unique_ptr<can::LogReader>> open_log(const std::string& path, bool is_interface) {
  auto reader = can::LogReader::open(path);
  if (!reader && is_interface) {
    reader.error().code = Code::interface; // the file takes the place of an interface
  }
  return reader;
}

/// The line output of this trace, appended to `out`.
std::unique_ptr<TraceOutput> make_lines(const TraceOptions& options, const Context& context,
                                        const bla::Profiles* profiles, std::string& out) {
  if (context.reporter().format() == Format::json) {
    return std::make_unique<JsonTrace>(out);
  }
  return std::make_unique<TextTrace>(out, *profiles,
                                     options.absolute ? Clock::wall : Clock::since_first);
}

void count(const Tracer& tracer, std::uint64_t lost, std::uint64_t bad_lines, Report& report) {
  const auto& counts = tracer.counts();
  report.counts = {{"frames", counts.frames},   {"transfers", counts.transfers},
                   {"errors", counts.errors},   {"lost", lost},
                   {"skipped", counts.skipped}, {"bad_lines", bad_lines}};
}

/// Notes on missing frames.
void tell_losses(const Tracer& tracer, const TraceRun& run, const can::LogReader* log,
                 const Reporter& reporter) {
  if (run.lost() > 0) {
    reporter.note(say<texts::frames_lost>(run.lost()));
  }
  if (run.unreadable() > 0) {
    reporter.note(say<texts::unreadable_frames>(run.unreadable()));
  }
  if (log != nullptr && log->bad_lines() > 0) {
    reporter.note(
        say<texts::lines_passed_over>(log->name(), log->bad_lines(), log->first_bad_line()));
  }
  if (tracer.counts().skipped > 0) {
    reporter.note(
        say<texts::log_has_many_interfaces>(tracer.counts().skipped, Tracer::most_interfaces));
  }
}

/// The source of frames: one of the two.
struct Source {
  std::unique_ptr<can::LogReader> log{};
  std::unique_ptr<can::Bus> bus{};
};

Result<Source> open_source(const TraceOptions& options, Context& context) {
  const Shared& shared = context.shared();
  if (const auto path = log_path(options, shared.interface)) {
    if (shared.record) {
      return fail(Code::usage, say<texts::nothing_to_record>("trace " + printable(*path)),
                  say<texts::see_command_help>("trace"));
    }
    auto log = open_log(*path, options.file.empty());
    return log ? Result<Source>(Source{.log = std::move(*log)}) : std::unexpected(log.error());
  }
  auto opened = context.open_bare();
  if (!opened) {
    return std::unexpected(opened.error());
  }
  auto bus = context.recorded(std::move(opened->bus));
  return bus ? Result<Source>(Source{.bus = std::move(*bus)}) : std::unexpected(bus.error());
}

/// `profiles`: null for a log as JSON.
void run_trace(const TraceOptions& options, TraceFilter filter, const bla::Profiles* profiles,
               Context& context, Report& report) {
  auto source = open_source(options, context);
  if (!source) {
    return report.fail(source.error());
  }
  const can::LogReader* log = source->log.get();
  std::string out;
  const auto stats = std::make_shared<TraceStats>();
  const auto lines = options.stats ? nullptr : make_lines(options, context, profiles, out);
  TraceOutput& output = lines ? *lines : *stats;
  Tracer tracer(std::move(filter), output,
                options.count.value_or(std::numeric_limits<std::uint64_t>::max()));
  StatsScreen screen(options.stats ? stats.get() : nullptr, context.reporter());
  TraceRun run(options.duration, context, tracer, screen, out, report);
  log != nullptr ? run.log(*source->log) : run.live(std::move(source->bus));

  count(tracer, run.lost(), log != nullptr ? log->bad_lines() : 0, report);
  tell_losses(tracer, run, log, context.reporter());
  if (options.stats) {
    report.json = [stats](JsonWriter& json) { stats->write(json); };
    report.text = [stats](const Page& page) { return stats->text(page); };
  }
}

Report execute(const TraceOptions& options, Context& context) {
  Report report;
  report.is_stream = true;
  const auto path = log_path(options, context.shared().interface);
  report.interface = path ? "replay:" + printable(*path) : printable(context.shared().interface);
  if (options.file.empty() && context.is_fleet_file()) {
    report.fail({Code::not_recorded, say<texts::file_without_frames>(report.interface),
                 say<texts::log_unreadable_hint>(), std::nullopt});
    return report;
  }
  auto filter = TraceFilter::make(options.filter, context.shared().nodes);
  if (!filter) {
    report.errors = std::move(filter.error());
    return report;
  }
  const bla::Profiles* profiles = nullptr;
  if (!path || context.reporter().format() != Format::json) {
    const auto loaded = context.profiles();
    if (!loaded) {
      report.fail(loaded.error());
      return report;
    }
    profiles = *loaded;
  }
  run_trace(options, std::move(*filter), profiles, context, report);
  return report;
}

} // namespace

constinit const Command commands::trace{
    .name = "trace",
    .traits = {.streams = true, .session = true, .recordings = true, .needs_frames = true},
    .help = {"every DroneCAN transfer decoded, live or from a log; sends nothing",
             "全 DroneCAN 転送をデコードして表示 (バスまたはログ。送信なし)"},
    .options = trace_options,
    .arguments = trace_arguments,
    .action = action<TraceOptions, execute>,
};

} // namespace blactl::cli
