// blactl trace: every DroneCAN transfer decoded, live or from a candump log.

#include "blactl/can/candump_reader.hpp"
#include "blactl/can/log_clock.hpp"
#include "blactl/can/loop.hpp"
#include "blactl/can/replay_texts.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/commands.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/texts.hpp"
#include "cli/trace/stats.hpp"
#include "cli/trace/texts.hpp"
#include "cli/trace/tracer.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace blactl::cli {
namespace {

struct TraceOptions {
  std::string file{}; ///< a candump log, or "-"; empty: the interface
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
     .kind = Kind::text,
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
              "表示する時間 (ログでは先頭からの秒数)"},
     .store = into<&TraceOptions::duration>},
    {.name = "--count",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, ~std::uint64_t{0}},
     .help = {"end after so many transfers", "この数の転送を表示したら終了"},
     .store = into<&TraceOptions::count>},
    {.name = "--stats",
     .kind = Kind::flag,
     .help = {"instead of the transfers, who sends what how often, and the load of the bus",
              "個々の転送の代わりに、送信元ごとの頻度とバス負荷を表示"},
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
     .help = {"a log of candump -l, or - (default: the interface)",
              "candump -l のログ、または - (省略時: インターフェース)"},
     .store = into<&TraceOptions::file>},
};

/// What is kept until it is written to stdout at once, where nobody waits for a line.
constexpr std::size_t block_size = 64 << 10;

/// How many lines of a log pass until somebody looks for Ctrl-C.
constexpr std::uint64_t lines_between_looks = 4096;

/// One run of the command: where frames come from, and what ends it.
class Trace {
 public:
  Trace(const TraceOptions& options, const Context& context, Tracer& tracer, std::string& out,
        Report& report)
      : options_(options), context_(context), tracer_(tracer), out_(out), report_(report) {}

  void live(std::unique_ptr<can::Bus> bus);
  void log(can::CandumpReader& reader);

  [[nodiscard]] std::uint64_t lost() const { return lost_; }

  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }

 private:
  /// What comes after the lines that were there.
  enum class Next : unsigned char { go_on, wait, stop };

  [[nodiscard]] bool handle(const can::Event& event, std::string_view interface, Time end);
  [[nodiscard]] bool take(const can::LogLine& line, const can::LogClock& clock);
  [[nodiscard]] Next take_lines(can::CandumpReader& reader, can::LogClock& clock);
  [[nodiscard]] bool flush();

  const TraceOptions& options_;
  const Context& context_;
  Tracer& tracer_;
  std::string& out_;
  Report& report_;
  std::uint64_t lost_ = 0;
  std::uint64_t unreadable_ = 0;
  bool has_frames_ = false; ///< the log
  WallTime begin_{};        ///< of the log
};

/// Writes what is there; false ends the trace.
bool Trace::flush() {
  if (out_.empty()) {
    return true;
  }
  const auto written = context_.reporter().stream(out_);
  out_.clear();
  if (!written) {
    report_.fail(written.error());
  }
  return written.value_or(false);
}

/// False ends the trace.
bool Trace::handle(const can::Event& event, std::string_view interface, Time end) {
  if (const auto* received = std::get_if<can::Received>(&event)) {
    if (received->at > end) {
      return false;
    }
    tracer_.receive({received->frame, received->at, received->wall, interface});
    return !tracer_.full();
  }
  if (const auto* overflow = std::get_if<can::Overflow>(&event)) {
    lost_ = overflow->lost;
  } else if (const auto* signal = std::get_if<can::Signal>(&event)) {
    if (signal->number != SIGWINCH) {
      report_.signal = signal->number;
      return false;
    }
  } else if (const auto* gone = std::get_if<can::Gone>(&event)) {
    report_.fail(gone->error);
    return false;
  }
  return !std::holds_alternative<can::Ended>(event);
}

void Trace::live(std::unique_ptr<can::Bus> bus) {
  can::Loop loop(std::move(bus));
  report_.interface = loop.bus().name();
  const Time end = options_.duration ? loop.now() + *options_.duration : never;
  bool goes_on = true;
  while (goes_on && loop.now() < end) {
    goes_on = handle(loop.next(std::min(end, tracer_.next_expiry())), report_.interface, end);
    if (goes_on && tracer_.next_expiry() <= loop.now()) {
      tracer_.expire(loop.now());
    }
    goes_on = flush() && goes_on;
  }
  unreadable_ = loop.bus().unreadable();
  context_.check_recording(report_);
}

/// False ends the trace.
bool Trace::take(const can::LogLine& line, const can::LogClock& clock) {
  if (line.kind == can::LogLine::Kind::other) {
    return true;
  }
  const WallTime at = clock.wall();
  begin_ = has_frames_ ? begin_ : at;
  has_frames_ = true;
  if (options_.duration && at - begin_ > *options_.duration) {
    return false;
  }
  if (line.kind == can::LogLine::Kind::frame) {
    // The log's own times, to the microsecond: its clock is the wall clock.
    tracer_.receive({line.frame, Time(at.time_since_epoch()), at, line.interface});
  }
  return !tracer_.full();
}

/// Takes the lines that are there, and does not wait.
Trace::Next Trace::take_lines(can::CandumpReader& reader, can::LogClock& clock) {
  for (std::uint64_t i = 0; i < lines_between_looks; ++i) {
    const auto line = reader.next();
    if (!line) {
      // A pipe has nothing for now: whoever looks shall see what came so far.
      return flush() ? Next::wait : Next::stop;
    }
    clock.pass(*line);
    if (!take(*line, clock) || (out_.size() >= block_size && !flush())) {
      return Next::stop;
    }
  }
  return Next::go_on;
}

void Trace::log(can::CandumpReader& reader) {
  can::Loop loop(nullptr);
  loop.watch(reader.descriptor());
  can::LogClock clock;
  while (!reader.ended()) {
    const Next next = take_lines(reader, clock);
    if (next == Next::stop) {
      (void)flush();
      return;
    }
    if (reader.ended()) {
      break;
    }
    const can::Event event = loop.next(next == Next::wait ? never : Time::min());
    if (const auto* signal = std::get_if<can::Signal>(&event);
        signal != nullptr && signal->number != SIGWINCH) {
      report_.signal = signal->number;
      (void)flush();
      return;
    }
  }
  tracer_.expire(never);
  (void)flush();
  if (const auto& error = reader.error()) {
    report_.fail(*error);
  } else if (!has_frames_) {
    report_.fail({Code::bad_file, say<texts::log_without_frames>(reader.name()),
                  say<texts::log_unreadable_hint>(), std::nullopt});
  }
}

/// The log that is meant; empty: none, an interface is.
std::optional<std::string> log_path(const TraceOptions& options, const std::string& interface) {
  if (!options.file.empty()) {
    return options.file;
  }
  const auto name = parse_interface(interface);
  return name && name->kind == InterfaceKind::replay ? std::optional(name->rest) : std::nullopt;
}

Result<std::unique_ptr<can::CandumpReader>> open_log(const std::string& path, bool is_interface) {
  auto reader = can::CandumpReader::open(path);
  if (!reader && is_interface) {
    reader.error().code = Code::interface; // the file stands where an interface would
  }
  return reader;
}

/// The lines of this trace, appended to `out`.
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

/// What the user should know of what is not there.
void tell_losses(const Tracer& tracer, const Trace& trace, const can::CandumpReader* log,
                 const Reporter& reporter) {
  if (trace.lost() > 0) {
    reporter.note(say<texts::frames_lost>(trace.lost()));
  }
  if (trace.unreadable() > 0) {
    reporter.note(say<texts::unreadable_frames>(trace.unreadable()));
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

/// Where the frames come from: one of both.
struct Source {
  std::unique_ptr<can::CandumpReader> log{};
  std::unique_ptr<can::Bus> bus{};
};

/// `profiles` are needed for a bus only.
Result<Source> open_source(const TraceOptions& options, const bla::Profiles* profiles,
                           Context& context) {
  const Shared& shared = context.shared();
  if (const auto path = log_path(options, shared.interface)) {
    if (shared.record) {
      return fail(Code::usage, say<texts::nothing_to_record>("trace " + printable(*path)),
                  say<texts::see_command_help>("trace"));
    }
    auto log = open_log(*path, options.file.empty());
    return log ? Result<Source>(Source{.log = std::move(*log)}) : std::unexpected(log.error());
  }
  auto opened = open_bus(shared.interface, *profiles, context.reporter());
  if (!opened) {
    return std::unexpected(opened.error());
  }
  auto bus = context.recorded(std::move(opened->bus));
  return bus ? Result<Source>(Source{.bus = std::move(*bus)}) : std::unexpected(bus.error());
}

/// `profiles`: null for a log as JSON.
void run(const TraceOptions& options, TraceFilter filter, const bla::Profiles* profiles,
         Context& context, Report& report) {
  auto source = open_source(options, profiles, context);
  if (!source) {
    return report.fail(source.error());
  }
  const can::CandumpReader* log = source->log.get();
  std::string out;
  const auto stats = std::make_shared<TraceStats>();
  const auto lines = options.stats ? nullptr : make_lines(options, context, profiles, out);
  TraceOutput& output = lines ? *lines : *stats;
  Tracer tracer(std::move(filter), output,
                options.count.value_or(std::numeric_limits<std::uint64_t>::max()));
  Trace trace(options, context, tracer, out, report);
  log != nullptr ? trace.log(*source->log) : trace.live(std::move(source->bus));

  count(tracer, trace.lost(), log != nullptr ? log->bad_lines() : 0, report);
  tell_losses(tracer, trace, log, context.reporter());
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
  run(options, std::move(*filter), profiles, context, report);
  return report;
}

} // namespace

constinit const Command commands::trace{
    .name = "trace",
    .traits = {.streams = true, .session = true, .recordings = true},
    .help = {"every DroneCAN transfer decoded, live or from a candump log; sends nothing",
             "全 DroneCAN 転送をデコードして表示 (バスまたは candump ログ。送信なし)"},
    .options = trace_options,
    .arguments = trace_arguments,
    .action = action<TraceOptions, execute>,
};

} // namespace blactl::cli
