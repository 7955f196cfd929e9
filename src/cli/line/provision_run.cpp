#include "cli/line/provision_run.hpp"

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/ticker.hpp"
#include "blactl/fleet/line/counter_check.hpp"
#include "blactl/fleet/line/line_record.hpp"

#include "cli/alloc/options.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/line/line_stores.hpp"
#include "cli/line/record_view.hpp"
#include "cli/line/station_name.hpp"
#include "cli/line/texts.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/stores.hpp"
#include "cli/trace/time.hpp"

#include <sys/timex.h>

#include <chrono>
#include <utility>

namespace blactl::cli {

using fleet::Station;
using fleet::StationStage;
using state::LedgerRecord;

namespace {

/// In the end errors of many units stand one below the other.
Error about_unit(const LedgerRecord& record, Error error) {
  if (record.serial_number) {
    error.message = say<texts::line_unit>(*record.serial_number, error.message);
  } else if (error.node_id) {
    error.message = say<texts::about_node>(*error.node_id, error.message);
  }
  return error;
}

/// For the bus to recover before it is tried again.
constexpr Duration pause = std::chrono::seconds(1);

/// Trouble of the bus that passes.
bool is_of_bus(Code code) {
  return code == Code::bus_off || code == Code::no_acknowledge || code == Code::interface;
}

/// That the times of records may be wrong; empty: the clock is synchronised.
std::optional<std::string> clock_remark() {
  timex state{};
  return adjtimex(&state) == TIME_ERROR ? std::optional(say<texts::provision_clock>())
                                        : std::nullopt;
}

} // namespace

ProvisionRun::ProvisionRun(const ProvisionOptions& options, fleet::Recipe recipe,
                           std::string recipe_sha256, Context& context, Report& report)
    : WritingRun(context, report), options_(options), recipe_(std::move(recipe)),
      common_(common_record(options, recipe_, std::move(recipe_sha256))),
      logs_(options.logs, context) {}

LedgerRecord ProvisionRun::common_record(const ProvisionOptions& options,
                                         const fleet::Recipe& recipe, std::string recipe_sha256) {
  LedgerRecord record = record_of_station(options.station);
  record.operator_name = unless_empty(options.operator_name);
  record.work_order = unless_empty(options.work_order);
  record.reason = unless_empty(options.reason);
  record.recipe = recipe.name;
  record.recipe_sha256 = std::move(recipe_sha256);
  return record;
}

Station::Options ProvisionRun::station_options() {
  Station::Options station{.recipe = recipe_,
                           .common = common_,
                           .manner = manner(),
                           .max_attempts = options_.max_attempts.value_or(3),
                           .redo = options_.redo,
                           .remark = clock_remark};
  station.manner.allocations = {};
  station.manner.progress = {};
  if (!options_.range.empty()) { // it was checked
    const auto range = parse_range(options_.range);
    station.first_bench_id = range->first;
    station.last_bench_id = range->last;
  }
  return station;
}

/// Whether one of the stores was lost: opened to write, it would begin anew.
Result<void> ProvisionRun::check_stores() const {
  const std::string& interface = context_.shared().interface;
  const auto counters = open_counters(interface, state::Access::read);
  if (!counters) {
    return std::unexpected(counters.error());
  }
  const auto ledger = open_ledger(interface, state::Access::read);
  return ledger ? check_line_stores(*ledger, *counters, interface)
                : std::unexpected(ledger.error());
}

void ProvisionRun::run() {
  if (const auto complete = check_stores(); !complete) {
    stop(complete.error());
    return;
  }
  auto ledger = open_ledger(context_.shared().interface, state::Access::write);
  auto counters = ledger ? open_counters(context_.shared().interface, state::Access::write)
                         : Result<state::CounterStore>(std::unexpected(ledger.error()));
  if (!counters) {
    stop(counters.error());
    return;
  }
  if (const auto known = fleet::check_counters(*ledger, *counters, recipe_); !known) {
    stop(known.error());
  } else if (begin()) {
    serve(*ledger, *counters);
  }
  if (events_ && events_->error()) {
    report_.fail(*events_->error());
  }
  for (const auto& [verdict, count] : totals_.verdicts) {
    report_.counts.emplace_back(verdict, count);
  }
}

bool ProvisionRun::begin() {
  if (const auto remark = clock_remark()) {
    context_.reporter().note(*remark);
  }
  if (!be_the_station() || !open_events()) {
    return false;
  }
  if (const auto opened = logs_.open(); !opened) {
    return stop(opened.error());
  }
  context_.wait_for_return();
  if (!open("provision", Recording::if_possible)) {
    return false;
  }
  context_.session().wait_alone();
  context_.session().break_off_when_away();
  return confirm(say<texts::provision_question>(printable(recipe_.model),
                                                recipe_.set.size() + recipe_.counters.size()));
}

void ProvisionRun::serve(state::LedgerStore& ledger, state::CounterStore& counters) {
  Station station(context_.session(), context_.known(), ledger, counters, station_options(),
                  [this](StationStage stage, auto serial_number) { tell(stage, serial_number); });
  const auto killed = station.end_interrupted();
  if (!killed) {
    stop(killed.error());
    return;
  }
  bool is_printed = put(records_header(context_.reporter().format()));
  for (const LedgerRecord& record : *killed) {
    is_printed = is_printed && print(record, std::nullopt);
  }
  open_screen();
  open_labels();
  constexpr Duration between_bells = std::chrono::milliseconds(300);
  std::optional<fleet::Ticker> ticker;
  if (view_) {
    ticker.emplace(context_.session(), between_bells, [this] {
      context_.signal() != 0 ? view_->stop() : void();
      view_->tick();
    });
  }
  while (is_printed && !is_complete() && next(station)) {
  }
  lines_.reset();
  context_.session().on_input(-1, {});
  context_.session().on_resize({});
  const bool had_screen = std::exchange(view_, nullptr) != nullptr;
  if (had_screen && !last_line_.empty()) { // it was seen on the screen alone
    (void)put(last_line_);
  }
  if (context_.reporter().format() == Format::text) {
    !totals_.owed.empty()
        ? context_.reporter().note(say<texts::station_owed>(numbers_of(totals_.owed)))
        : void();
    context_.reporter().note(text_of(totals_));
  }
}

/// What is begun in the ledger is its own; that of a private simulation is nobody else's.
bool ProvisionRun::be_the_station() {
  if (names(context_.shared().interface, Behind::scenario)) {
    return true;
  }
  auto lock =
      state::StationLock::acquire(stores_folder(context_.shared().interface), *common_.station);
  if (!lock) {
    return stop(lock.error());
  }
  station_ = std::move(*lock);
  return true;
}

/// Whether the run goes on.
bool ProvisionRun::next(Station& station) {
  if (lines_ && !label_) {
    return wait_for_label(station);
  }
  const auto arrival = station.wait_for_servo(idle_deadline());
  if (!arrival) {
    return goes_on_after(arrival.error());
  }
  if (!*arrival) {
    end_by_idling();
    return false;
  }
  return work_on(station, **arrival) && (is_complete() || take_off(station));
}

bool ProvisionRun::work_on(Station& station, const Station::Arrival& arrival) {
  const auto record = station.work_on(arrival, label_ ? &*label_ : nullptr);
  if (!record) { // what is not recorded is no result
    return stop(record.error());
  }
  const auto& reason = station.reason();
  view_ ? view_->take(*record, reason, station.is_repeating(), station.is_servo_there()) : void();
  const bool is_printed = conclude(*record, station);
  if (record->verdict != fleet::verdict::error) {
    label_.reset();
    show_label();
  }
  if (context_.signal() != 0) {
    report_.signal = context_.signal();
    return false;
  }
  if (reason && is_of_bus(reason->code) && !goes_on_after(*reason)) {
    return false;
  }
  const bool is_at_end = reason && reason->code == Code::counter_end;
  if (options_.stop_after && failed_in_row_ >= *options_.stop_after) {
    context_.reporter().note(say<texts::provision_stopped>(failed_in_row_));
    return false;
  }
  return is_printed && !is_at_end;
}

/// What is told of every record, beside the screen.
bool ProvisionRun::conclude(const LedgerRecord& record, const Station& station) {
  const auto& reason = station.reason();
  tell_event(*record.verdict, &record, reason ? reason->message : std::string());
  logs_.keep(record);
  const Reporter& reporter = context_.reporter();
  last_line_ = record_line(record, reporter.format(), reporter.page(), reason);
  const bool is_printed = view_ || put(last_line_);
  account(record, reason);
  return is_printed;
}

/// `stands`: whether the last result does, as its unit is there.
bool ProvisionRun::refuse_joined(Station& station, bool stands) {
  const auto record = station.refuse_joined();
  if (!record) {
    return stop(record.error());
  }
  if (view_) {
    stands ? view_->join(*record, station.reason())
           : view_->take(*record, station.reason(), station.is_repeating(), true);
  }
  return conclude(*record, station);
}

bool ProvisionRun::take_off(Station& station) {
  for (;;) {
    const auto left = station.wait_until_off(idle_deadline());
    const bool is_joined = left && *left == Station::Leaving::joined;
    if (is_joined || (left && *left == Station::Leaving::doubled)) {
      if (!refuse_joined(station, is_joined)) {
        return false;
      }
      continue;
    }
    if (left && *left != Station::Leaving::late) {
      return true;
    }
    if (left) {
      end_by_idling();
    }
    if (left || !goes_on_after(left.error())) {
      return false;
    }
  }
}

bool ProvisionRun::print(const LedgerRecord& record, const std::optional<Error>& reason) {
  const Reporter& reporter = context_.reporter();
  return put(record_line(record, reporter.format(), reporter.page(), reason));
}

/// False: the reader has left, or there is no room; then nothing more is begun.
bool ProvisionRun::put(std::string_view text) {
  const auto printed = context_.reporter().stream(text);
  return printed ? *printed : stop(printed.error());
}

void ProvisionRun::account(const LedgerRecord& record, const std::optional<Error>& reason) {
  totals_.add(record);
  counted_ += record.verdict != fleet::verdict::error ? 1U : 0U;
  if (record.verdict == fleet::verdict::fail) {
    ++failed_in_row_;
  } else if (record.verdict != fleet::verdict::error) {
    failed_in_row_ = 0;
  }
  if (reason) {
    report_.fail_target(about_unit(record, *reason));
  } else {
    report_.targets.emplace_back();
  }
}

bool ProvisionRun::is_complete() const {
  return options_.count && counted_ >= *options_.count;
}

/// The line survives trouble of the bus; a signal ends it, and an interface that never comes back.
bool ProvisionRun::goes_on_after(const Error& error) {
  fleet::Session& session = context_.session();
  const bool is_lost = error.code == Code::interface && !session.away();
  if (!is_of_bus(error.code) || is_lost || context_.signal() != 0) {
    context_.ended(error, report_);
    return false;
  }
  context_.reporter().note(session.away() ? say<texts::provision_adapter>(error.message)
                                          : say<texts::provision_trouble>(error.message));
  tell_event("no_bus", nullptr);
  if (view_) {
    view_->lose_bus(session.away().has_value());
  }
  const auto lived = session.away()
                         ? session.live_until(never, [&] { return !session.away(); })
                         : session.live_until(session.now() + pause, [] { return false; });
  return lived || goes_on_after(lived.error());
}

Time ProvisionRun::idle_deadline() const {
  return options_.idle_timeout ? context_.session().now() + *options_.idle_timeout : never;
}

void ProvisionRun::end_by_idling() {
  if (options_.count) {
    stop({Code::not_found, say<texts::provision_idle>(whole_seconds(*options_.idle_timeout)),
          say<texts::provision_idle_hint>(counted_, *options_.count), std::nullopt});
  }
}

} // namespace blactl::cli
