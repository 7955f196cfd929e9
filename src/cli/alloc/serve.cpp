#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/ticker.hpp"
#include "blactl/fleet/change/table_entries.hpp"
#include "blactl/fleet/change/wanted_ids.hpp"

#include "cli/alloc/actions.hpp"
#include "cli/alloc/texts.hpp"
#include "cli/alloc/view.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/stores.hpp"
#include "cli/texts.hpp"
#include "cli/trace/time.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using fleet::AllocatedUnit;
using fleet::AllocationService;
using Event = AllocationService::Event;
using state::AllocationStore;

/// A unit without a node ID repeats its request after 1 s at most (1.Allocation.uavcan): silence of
/// this length means that no unit asks, even if two requests were lost.
constexpr Duration quiet_time = std::chrono::seconds(3);

/// The longest time from the response to a unit's first frame under the new ID.
constexpr Duration come_up_time = std::chrono::seconds(3);

/// A unit that asks for longer without completing an allocation is not following the protocol.
constexpr Duration patience = std::chrono::seconds(30);

constexpr std::size_t few_ids = 5;

/// One run of the allocator.
class Serve {
 public:
  Serve(const AllocOptions& options, AllocationService::Range range,
        std::vector<fleet::WantedId> wanted, Context& context, AllocationStore& store,
        Report& report)
      : options_(options), context_(context), store_(store), report_(report),
        progress_at_(context.session().now()), range_(range), wanted_(std::move(wanted)) {
    if (wanted_.empty()) { // else units of the table wait for a second
      begin();
    }
  }

  void run();

 private:
  [[nodiscard]] fleet::Session& session() const { return context_.session(); }

  void begin();
  [[nodiscard]] bool enter_wishes();
  void remember();
  void check(const Result<bool>& printed);
  void tell(Event event, const AllocatedUnit& unit);
  void redraw();
  void tell_space();
  [[nodiscard]] std::size_t there() const;
  [[nodiscard]] bool is_coming_up() const;
  [[nodiscard]] bool is_over() const;
  [[nodiscard]] bool is_quiet() const;
  [[nodiscard]] bool is_stuck() const;
  void broken(const Error& error);
  [[nodiscard]] bool wait();
  [[nodiscard]] bool look_for_twins(fleet::Discovery& discovery);
  void tell_quiet();
  void conclude();

  const AllocOptions& options_;
  Context& context_;
  AllocationStore& store_;
  Report& report_;
  Time progress_at_; ///< when an allocation last made progress
  AllocationService::Range range_;
  bool has_reader_ = true;
  std::uint64_t assigned_ = 0, kept_ = 0;
  std::vector<fleet::WantedId> wanted_;
  std::optional<AllocationService> service_;
};

void Serve::begin() {
  service_.emplace(session(), store_, range_,
                   [this](Event event, const AllocatedUnit& unit) { tell(event, unit); });
}

/// What a person wishes is taken over from a unit that is not on this bus. Returns whether all
/// wishes are entered.
bool Serve::enter_wishes() {
  auto [wishes, errors] = fleet::units_meant(wanted_, session().roster(), context_.known());
  for (const AllocationStore::Wish& wish : wishes) {
    auto may = fleet::may_have(session().roster(), wish.unique_id, wish.node_id);
    if (!may) {
      errors.push_back(std::move(may.error()));
    }
  }
  std::ranges::move(errors, std::back_inserter(report_.errors));
  if (!report_.errors.empty()) {
    return false;
  }
  const auto notes = fleet::enter_wishes(store_, wishes, session().wall());
  if (!notes) {
    report_.fail(notes.error());
    return false;
  }
  for (const std::string& note : *notes) {
    context_.reporter().note(note);
  }
  for (const AllocationStore::Wish& wish : wishes) {
    context_.reporter().note(
        say<texts::alloc_wish_taken>(hex(wish.unique_id), wish.node_id.value()));
  }
  return true;
}

/// The servos that are here enter the table.
void Serve::remember() {
  const auto entered =
      fleet::enter_seen(store_, session().roster(), session().now(), session().wall());
  if (!entered && report_.errors.empty()) {
    report_.fail(entered.error());
  }
}

/// Ends the run if the reader has left.
void Serve::check(const Result<bool>& printed) {
  if (!printed) {
    report_.fail(printed.error());
  }
  has_reader_ = has_reader_ && printed.value_or(false);
}

void Serve::tell(Event event, const AllocatedUnit& unit) {
  assigned_ += event == Event::assigned ? 1 : 0;
  kept_ += event == Event::kept ? 1 : 0;
  const bool is_progress = event != Event::request && event != Event::deaf;
  progress_at_ = is_progress ? session().now() : progress_at_;
  const Reporter& reporter = context_.reporter();
  const WallTime time = session().wall();
  if (reporter.format() == Format::json) {
    check(reporter.stream(json_line(UnixTime(time), event, unit)));
  } else if (!reporter.has_screen()) {
    check(reporter.stream(text_line(time, event, unit)));
  }
  if (event == Event::assigned) {
    for (const std::string& note : fleet::taken_over(std::span(&unit, 1))) {
      context_.reporter().note(note);
    }
    tell_space();
  }
}

/// Warns before the bus is full.
void Serve::tell_space() {
  if (const auto free = service_->free_ids(); free <= few_ids) {
    context_.reporter().note(say<texts::alloc_few_left>(free));
  }
}

/// On a terminal the list of units is redrawn, instead of a line for each event.
void Serve::redraw() {
  const Reporter& reporter = context_.reporter();
  if (reporter.has_screen()) {
    check(reporter.show(text(*service_, session().roster(), reporter.page())));
  }
}

std::size_t Serve::there() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      service_->units(), [this](const auto& entry) { return service_->is_there(entry.second); }));
}

/// Whether a recently assigned ID was not heard yet.
bool Serve::is_coming_up() const {
  return std::ranges::any_of(service_->units(), [this](const auto& entry) {
    const AllocatedUnit& unit = entry.second;
    return unit.node_id.is_unicast() && !unit.refused && !unit.is_deaf &&
           !service_->is_there(unit) && session().now() - unit.asked_at < come_up_time;
  });
}

/// One that has asked once is waited for; who babbles asks once again and again, which must end.
bool Serve::is_quiet() const {
  const Duration enough = service_->units().empty() ? options_.wait : quiet_time;
  const Duration silence = session().now() - service_->last_request();
  const bool may_come = service_->may_begin_to_ask() && silence < enough + quiet_time;
  return silence >= enough && !may_come && !is_coming_up();
}

/// Whether units keep asking without progress.
bool Serve::is_stuck() const {
  return session().now() - progress_at_ >= std::max(patience, options_.wait);
}

bool Serve::is_over() const {
  return !has_reader_ || service_->end() || (options_.count && there() >= *options_.count) ||
         (options_.once && (is_quiet() || is_stuck()));
}

/// Without another end a signal is the one that the user has chosen.
void Serve::broken(const Error& error) {
  const bool has_end = options_.once || options_.count;
  has_end ? context_.broken(error, report_) : context_.ended(error, report_);
}

/// Returns whether the session is still alive.
bool Serve::wait() {
  constexpr Duration interval = std::chrono::milliseconds(250); // within a person's patience
  const fleet::Ticker ticker(session(), interval, [this] { redraw(); });
  while (!is_over()) {
    // conditions of time alone are checked with every tick
    const auto lived =
        session().live_until(session().now() + interval, [this] { return is_over(); });
    if (!lived) {
      broken(lived.error());
      return false;
    }
  }
  return true;
}

/// Identifies the nodes on assigned IDs: a second unit on one of them responds, too. Returns
/// whether the session is still alive.
bool Serve::look_for_twins(fleet::Discovery& discovery) {
  std::vector<const fleet::Member*> members;
  for (const AllocatedUnit& unit : service_->units() | std::views::values) {
    if (service_->is_there(unit) || unit.is_shared) {
      members.push_back(session().roster().find(unit.node_id));
    }
  }
  const auto looked = discovery.look_for_twins(members);
  if (!looked) {
    broken(looked.error());
  }
  return looked.has_value();
}

void Serve::run() {
  auto identification = context_.identification();
  identification.static_node_id = true;
  fleet::Discovery discovery(session(), context_.known(), identification);
  if (const auto found = discovery.find_all(fleet::bus_watch_time); !found) {
    broken(found.error());
    return service_ ? conclude() : report_.count_targets();
  }
  if (!wanted_.empty()) {
    if (!enter_wishes()) {
      report_.count_targets();
      return;
    }
    begin();
  }
  service_->bus_is_known();
  if (!service_->end()) {
    context_.reporter().note(
        say<texts::alloc_started>(range_.first.value(), range_.last.value(), service_->free_ids()));
  }
  while (wait() && look_for_twins(discovery) && !is_over()) {
    // a unit asked meanwhile, or is one of two
  }
  redraw();
  conclude();
}

/// Notes why the run ends: no unit asks any more, or none makes progress.
void Serve::tell_quiet() {
  const auto seconds = [this](Time since) { return whole_seconds(session().now() - since); };
  if (!is_quiet() && is_stuck()) {
    report_.fail({Code::timeout,
                  say<texts::alloc_unfinished>(service_->asking(), seconds(progress_at_)),
                  say<texts::alloc_unfinished_hint>(), std::nullopt});
  } else if (is_quiet()) {
    const bool refuses =
        std::ranges::any_of(service_->units() | std::views::values,
                            [](const AllocatedUnit& unit) { return unit.refused || unit.is_deaf; });
    const auto silence = seconds(service_->last_request());
    context_.reporter().note(refuses ? say<texts::alloc_quiet_others>(silence)
                                     : say<texts::alloc_quiet>(silence));
  }
}

void Serve::conclude() {
  remember();
  if (auto end = service_->end()) {
    report_.fail(std::move(*end));
  }
  for (const AllocatedUnit& unit : service_->units() | std::views::values) {
    if (auto refusal = service_->refusal(unit)) {
      report_.fail_target(std::move(*refusal));
    } else if (unit.node_id.is_unicast() && !service_->is_there(unit)) {
      report_.fail_target(service_->absence(unit));
    } else if (unit.node_id.is_unicast()) { // else it has no ID, and nothing prevents one
      report_.targets.emplace_back();
    }
  }
  if (options_.once && report_.errors.empty()) {
    tell_quiet();
  }
  if (options_.once && options_.count && there() < *options_.count && report_.errors.empty()) {
    report_.fail({Code::not_found, say<texts::alloc_expected_more>(there(), *options_.count),
                  say<texts::alloc_expected_more_hint>(), std::nullopt});
  }
  report_.counts = {{"assigned", assigned_}, {"kept", kept_}};
  report_.count_targets();
}

/// The reason why no ID can be allocated: no frame may be sent.
std::optional<Error> refuse(const Context& context) {
  if (context.shared().listen_only) {
    return Error{Code::usage, say<texts::listen_only_refused>("alloc"),
                 say<texts::listen_only_hint>(), std::nullopt};
  }
  return takes_no_frames(context.shared().interface);
}

} // namespace

Report serve_allocations(const AllocOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = true};
  const auto range = parse_range(options.range);
  auto wanted = parse_wishes(options.assign);
  if (!range) {
    report.fail(range.error());
  }
  if (!wanted) {
    std::ranges::copy(wanted.error(), std::back_inserter(report.errors));
  }
  if (auto refused = refuse(context)) {
    report.fail(std::move(*refused));
  }
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
  }
  if (!report.errors.empty()) {
    return report;
  }
  auto store = open_allocations(context.shared().interface, AllocationStore::Access::write);
  if (!store) {
    report.fail(store.error());
    return report;
  }
  if (const auto session = context.open_for_allocation(); !session) {
    report.fail(session.error());
    return report;
  }
  report.interface = context.session().interface();
  if (store->path().empty()) {
    context.reporter().note(say<texts::alloc_not_kept>());
  }
  Serve(options, *range, std::move(*wanted), context, *store, report).run();
  return report;
}

} // namespace blactl::cli
