// blactl monitor: servos as they are now, on a screen or as a stream.

#include "blactl/fleet/guard.hpp"

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/monitor/sample.hpp"
#include "cli/monitor/texts.hpp"
#include "cli/monitor/view.hpp"
#include "cli/texts.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

namespace blactl::cli {
namespace {

struct MonitorOptions {
  Duration rate = std::chrono::seconds(2); ///< samples a second, as if they were seconds
  std::string fields{};                    ///< keys, with commas between them; empty: all
  std::optional<Duration> duration{};
  std::optional<std::uint64_t> count{};

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
     .help = {"end after so many samples", "この回数サンプルしたら終了"},
     .store = into<&MonitorOptions::count>},
};

SampleFields chosen_fields(const std::string& keys) {
  SampleFields fields;
  for (const SampleField field : all_sample_fields()) {
    const std::string key(sample_keys[static_cast<std::size_t>(field)]);
    if (keys.empty() || (',' + keys + ',').find(',' + key + ',') != std::string::npos) {
      fields.push_back(field);
    }
  }
  return fields;
}

/// One run of the command, once the session is open.
class MonitorRun {
 public:
  MonitorRun(const MonitorOptions& options, fleet::Targets targets, Context& context,
             Report& report);

  void run();

 private:
  void open_screen();
  [[nodiscard]] bool is_past_duration(Time now);
  void sample(Time now);
  void stream(const std::vector<fleet::LiveServo>& servos);
  void check(const Result<bool>& printed);
  void conclude();

  const MonitorOptions& options_;
  Context& context_;
  Report& report_;
  SampleFields fields_;
  std::unique_ptr<MonitorView> view_; ///< null: lines
  fleet::Monitor monitor_;
  std::optional<Time> begin_; ///< of a recording, whose time is its own
  std::uint64_t samples_ = 0;
  bool has_header_ = false;
  bool is_over_ = false;
};

MonitorRun::MonitorRun(const MonitorOptions& options, fleet::Targets targets, Context& context,
                       Report& report)
    : options_(options), context_(context), report_(report), fields_(chosen_fields(options.fields)),
      monitor_(context.session(), context.known(), std::move(targets),
               {.identification = context.identification(),
                .fields = live_fields_of(fields_),
                .period = options.period(),
                .sample = [this](Time now) { sample(now); }}) {}

/// Without a screen it prints lines: where the terminal cannot be drawn on, and for a recording,
/// which is over at once.
void MonitorRun::open_screen() {
  const Reporter& reporter = context_.reporter();
  if (reporter.format() != Format::text || !reporter.has_screen() ||
      context_.session().is_recording()) {
    return;
  }
  auto screen = Screen::open(reporter.page().colour);
  if (!screen) {
    return reporter.note(say<texts::monitor_other_screen>(screen.error().message));
  }
  fleet::Session& session = context_.session();
  view_ =
      std::make_unique<MonitorView>(std::move(*screen), reporter, report_.interface, session.now());
  if (Screen::input() >= 0) {
    session.on_input(Screen::input(), [this] {
      is_over_ = is_over_ || !view_->take_keys(context_.session().now());
      monitor_.watch_limits(view_->shown());
    });
  }
  session.on_resize([this] { view_->draw(context_.session().now()); });
  view_->draw(session.now());
}

/// A reader that has left ends the run.
void MonitorRun::check(const Result<bool>& printed) {
  if (!printed) {
    report_.fail(printed.error());
  }
  is_over_ = is_over_ || !printed.value_or(false);
}

void MonitorRun::stream(const std::vector<fleet::LiveServo>& servos) {
  const Reporter& reporter = context_.reporter();
  const WallTime wall = context_.session().wall();
  std::string out;
  if (!std::exchange(has_header_, true) && reporter.format() != Format::json) {
    out = reporter.format() == Format::csv ? csv_header(fields_) : text_header(fields_);
  }
  for (const fleet::LiveServo& servo : servos) {
    switch (reporter.format()) {
    case Format::json: out += json_sample(wall, servo, fields_); break;
    case Format::csv: out += csv_sample(wall, servo, fields_); break;
    case Format::text: out += text_sample(wall, servo, fields_); break;
    }
  }
  check(reporter.stream(out));
}

/// A session on a recording hears all of it, whatever the time.
bool MonitorRun::is_past_duration(Time now) {
  if (!context_.session().is_recording() || !options_.duration) {
    return false;
  }
  begin_ = begin_.value_or(now - options_.period());
  return now - *begin_ > *options_.duration;
}

void MonitorRun::sample(Time now) {
  if (is_over_ || is_past_duration(now)) {
    is_over_ = true;
    return;
  }
  auto servos = monitor_.servos(now);
  if (view_) {
    view_->take(std::move(servos), now);
  } else {
    stream(servos);
  }
  is_over_ = is_over_ || ++samples_ == options_.count;
}

/// What of the servos is a failure of the command.
void MonitorRun::conclude() {
  const fleet::Session& session = context_.session();
  const auto servos = monitor_.servos(session.now());
  for (const fleet::LiveServo& servo : servos) {
    report_.targets.emplace_back();
    if (servo.is_doubled) {
      report_.targets.back().errors.push_back(fleet::doubled(session.roster(), servo.servo.id));
    }
  }
  report_.count_targets();
  report_.counts.emplace_back("samples", samples_);
}

void MonitorRun::run() {
  fleet::Session& session = context_.session();
  session.wait_alone();
  open_screen();
  const Time end = options_.duration ? session.now() + *options_.duration : never;
  const auto lived = session.live_until(end, [this] { return is_over_; });
  if (session.is_recording() && lived) {
    sample(session.now()); // what came after the last one
  }
  session.on_input(-1, {});
  view_.reset();
  if (!lived) {
    context_.broken(lived.error(), report_);
  }
  conclude();
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
  if (const auto session = context.open(fleet::Session::Hearing::answers); !session) {
    report.fail(session.error());
    return report;
  }
  report.interface = context.session().interface();
  MonitorRun(options, std::move(*targets), context, report).run();
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
