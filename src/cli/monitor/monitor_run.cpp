#include "cli/monitor/monitor_run.hpp"

#include "blactl/fleet/bus/unreachable.hpp"

#include "cli/monitor/texts.hpp"
#include "cli/output/progress_view.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <utility>

namespace blactl::cli {

MonitorRun::MonitorRun(MonitorManner manner, fleet::Targets targets, Context& context,
                       Report& report)
    : manner_(std::move(manner)), context_(context), report_(report),
      monitor_(context.session(), context.known(), std::move(targets), options()) {}

/// Only the angle shows whether a shaft turns.
fleet::Monitor::Options MonitorRun::options() {
  fleet::Monitor::Options options{.identification = context_.identification(),
                                  .fields = live_fields_of(manner_.fields),
                                  .period = manner_.period,
                                  .watches_turns = manner_.identifies,
                                  .sample = [this](Time now) { sample(now); }};
  if (manner_.identifies && std::ranges::count(options.fields, fleet::LiveField::angle) == 0) {
    options.fields.push_back(fleet::LiveField::angle);
  }
  return options;
}

/// It prints lines without a screen: if the terminal cannot be drawn on, or for a recording that is
/// over at once.
void MonitorRun::open_screen() {
  const Reporter& reporter = context_.reporter();
  if (reporter.format() != Format::text || !reporter.has_screen() ||
      (context_.session().is_replay() && context_.pace() == nullptr)) {
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
    session.on_input(Screen::input(), [this] { take_keys(); });
  }
  if (context_.pace() != nullptr) {
    view_->on_other_keys([this](Key key) { take_other_key(key); }, say<texts::monitor_keys_log>());
  }
  session.on_resize([this] { view_->draw(context_.session().now()); });
  tell_state();
}

/// Shows whether the interface is present.
void MonitorRun::tell_presence() {
  if (view_) {
    return tell_state();
  }
  const auto& away = context_.session().away();
  context_.reporter().note(away ? say<texts::monitor_away>(away->message)
                                : say<texts::monitor_back>(report_.interface));
}

/// The position within a log.
std::string MonitorRun::playing() const {
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(context_.session().now().time_since_epoch());
  const int doublings = context_.pace()->doublings();
  std::string text = say<texts::monitor_played>(seconds.count());
  if (context_.session().has_played()) {
    text = say<texts::monitor_played_out>();
  } else if (doublings > 0) {
    text += ", " + say<texts::monitor_played_faster>(1 << doublings);
  } else if (doublings < 0) {
    text += ", " + say<texts::monitor_played_slower>(1 << -doublings);
  }
  return text;
}

/// Shows the state in the title of the screen.
void MonitorRun::tell_state() {
  const fleet::Session& session = context_.session();
  ScreenLine state;
  if (context_.pace() != nullptr) {
    state.push_back({"  " + playing()});
  }
  if (session.away()) {
    state.push_back({"  " + say<texts::monitor_gone>(), Look::bad});
  }
  if (manner_.identifies) {
    const std::string holding = manner_.holding.empty()
                                    ? std::string()
                                    : say<texts::monitor_holding>(short_list(manner_.holding));
    state.push_back({"  " + say<texts::monitor_identifies>() + holding, Look::warning});
  }
  view_->tell(std::move(state));
  view_->draw(session.now());
}

void MonitorRun::take_keys() {
  was_quit_ = was_quit_ || !view_->take_keys(context_.session().now());
  is_over_ = is_over_ || was_quit_;
  monitor_.watch_limits(view_->shown());
  if (can::PacedReplay* pace = context_.pace()) {
    pace->pause(view_->is_paused());
  }
}

void MonitorRun::take_other_key(Key key) {
  if (key == U'+' || key == U'>') {
    context_.pace()->go_faster();
  } else if (key == U'-' || key == U'<') {
    context_.pace()->go_slower();
  }
  tell_state();
}

/// The last state of a log stays until the user has seen it.
bool MonitorRun::shall_end() {
  const bool has_played = context_.session().has_played();
  if (has_played && view_ && !std::exchange(told_end_, true)) {
    tell_state();
  }
  return is_over_ || (has_played && (!view_ || Screen::input() < 0));
}

/// Ends the run if the reader has left.
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
    out =
        reporter.format() == Format::csv ? csv_header(manner_.fields) : text_header(manner_.fields);
  }
  for (const fleet::LiveServo& servo : servos) {
    switch (reporter.format()) {
    case Format::json: out += json_sample(wall, servo, manner_.fields); break;
    case Format::csv: out += csv_sample(wall, servo, manner_.fields); break;
    case Format::text: out += text_sample(wall, servo, manner_.fields); break;
    }
  }
  check(reporter.stream(out));
}

/// A session on a recording receives all of it, whatever the time.
bool MonitorRun::is_past_duration(Time now) {
  if (!context_.session().is_replay() || !manner_.duration) {
    return false;
  }
  begin_ = begin_.value_or(now - manner_.period);
  return now - *begin_ > *manner_.duration;
}

void MonitorRun::sample(Time now) {
  if (is_over_ || is_past_duration(now)) {
    is_over_ = true;
    return;
  }
  auto servos = monitor_.servos(now);
  if (view_) {
    if (context_.pace() != nullptr) {
      tell_state();
    }
    view_->take(std::move(servos), now);
  } else {
    stream(servos);
  }
  is_over_ = is_over_ || ++samples_ == manner_.count;
}

void MonitorRun::run() {
  fleet::Session& session = context_.session();
  session.wait_alone();
  session.on_away([this] { tell_presence(); });
  open_screen();
  const Time end = manner_.duration ? session.now() + *manner_.duration : never;
  const auto lived = session.live_until(end, [this] { return shall_end(); });
  if (session.is_replay() && lived) {
    sample(session.now()); // the samples after the last one
  }
  is_over_ = true;
  session.on_away({});
  session.on_input(-1, {});
  session.on_resize({});
  view_.reset();
  if (!lived) {
    context_.broken(lived.error(), report_);
  }
}

/// Reports errors of servos. If the bus could not be heard to the end, missing ones are not known.
void MonitorRun::conclude(std::span<const Error> errors) {
  const fleet::Session& session = context_.session();
  std::map<std::optional<std::uint8_t>, Target> targets;
  for (const fleet::LiveServo& servo : monitor_.servos(session.now())) {
    Target& target = targets[servo.servo.id.value()];
    if (servo.is_doubled) {
      target.errors.push_back(fleet::doubled(session.roster(), servo.servo.id));
    }
  }
  for (const Error& error : errors) {
    targets[error.node_id].errors.push_back(error);
  }
  const bool was_heard = report_.errors.empty() || report_.signal != 0;
  for (Error& error : was_heard ? monitor_.missing(session.now()) : std::vector<Error>{}) {
    if (!error.node_id) {
      report_.fail_target(std::move(error));
    } else if (Target& target = targets[error.node_id]; target.errors.empty()) {
      target.errors.push_back(std::move(error));
    }
  }
  for (auto& [id, target] : targets) {
    report_.targets.push_back(std::move(target));
  }
  report_.count_targets();
  report_.counts.emplace_back("samples", samples_);
}

} // namespace blactl::cli
