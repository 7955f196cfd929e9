#include "cli/faults/watch.hpp"

#include "blactl/fleet/live/fault_watch.hpp"

#include "cli/output/faults_view.hpp"
#include "cli/output/node_head.hpp"
#include "cli/texts.hpp"
#include "cli/trace/time.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using bla::Fault;
using dronecan::NodeId;
using fleet::FaultState;

constexpr Duration interval = std::chrono::milliseconds(500);

/// The event of a fault: present when the watch began, came, went; or of a servo: it restarted,
/// does not answer any more, answers again.
enum class Event : std::uint8_t { present, came, went, restarted, gone, back };

struct EventName {
  std::string_view word;
  std::string (*text)(); ///< for people, who read of silence among the notes; null: none
};

/// In the order of Event.
constexpr EventName event_names[]{
    {"present", [] { return say<texts::fault_present>(); }},
    {"came", [] { return say<texts::fault_came>(); }},
    {"went", [] { return say<texts::fault_went>(); }},
    {"restarted", [] { return say<texts::servo_restarted>(); }},
    {"gone", nullptr},
    {"back", nullptr},
};

class Watch {
 public:
  Watch(bla::Level shown, Context& context, Report& report)
      : shown_(shown), context_(context), report_(report) {}

  /// Takes the latest reads. False ends the watch.
  [[nodiscard]] bool take(std::vector<FaultState> seen);

  [[nodiscard]] const std::map<NodeId, FaultState>& last() const { return last_; }

 private:
  [[nodiscard]] bool take(FaultState now);
  [[nodiscard]] bool tell(Event event, const FaultState& servo, const Fault* fault = nullptr);
  [[nodiscard]] bool tell_restart(const FaultState& now);
  [[nodiscard]] bool redraw();
  [[nodiscard]] bool check(const Result<bool>& printed);
  [[nodiscard]] bool tell_silence(const FaultState& now);
  void tell_refusal(FaultState& now, std::span<const Fault> had);

  bla::Level shown_;
  Context& context_;
  Report& report_;
  std::map<NodeId, FaultState> last_; ///< the last reads of each servo
  std::set<NodeId> silent_, refusing_;
  std::map<NodeId, std::uint32_t> boots_; ///< as last told
};

/// False: the reader of stdout has left.
bool Watch::check(const Result<bool>& printed) {
  if (!printed) {
    report_.fail(printed.error());
  }
  return printed.value_or(false);
}

/// `fault`: null for an event of the servo itself.
bool Watch::tell(Event event, const FaultState& servo, const Fault* fault) {
  const EventName& name = event_names[std::to_underlying(event)];
  const UnixTime time(context_.session().wall());
  if (fault != nullptr && fault->level < shown_) {
    return true;
  }
  if (context_.reporter().format() == Format::json) {
    std::string line;
    JsonWriter json(line);
    json.begin_object();
    json.key("time");
    json.number(time.text());
    write_head(json, servo.snapshot.servo);
    json.member("event", name.word);
    if (fault != nullptr) {
      write_fault(json, servo, *fault);
    }
    json.end_object();
    return check(context_.reporter().stream(line + '\n'));
  }
  if (context_.reporter().has_screen() || name.text == nullptr) {
    return true; // the list shows it
  }
  std::string line = say<texts::fault_event>(
      time.text(), servo.snapshot.servo.id.value(), name.text(),
      fault != nullptr ? fault_line(*fault, context_.reporter().page()) : std::string());
  line.erase(line.find_last_not_of(' ') + 1);
  return check(context_.reporter().stream(line + '\n'));
}

/// A servo that does not respond keeps its last known faults.
bool Watch::tell_silence(const FaultState& now) {
  const NodeId id = now.snapshot.servo.id;
  const bool has_answered = now.has_answered();
  const bool is_news = has_answered ? silent_.erase(id) > 0 : silent_.insert(id).second;
  if (!is_news) {
    return true;
  }
  if (!context_.reporter().has_screen()) { // the list shows it
    context_.reporter().note(has_answered ? say<texts::answers_again>(id.value())
                                          : now.errors.front().message);
  }
  const auto before = last_.find(id);
  return tell(has_answered ? Event::back : Event::gone,
              has_answered || before == last_.end() ? now : before->second);
}

bool Watch::tell_restart(const FaultState& now) {
  const NodeId id = now.snapshot.servo.id;
  const std::uint32_t boots = context_.session().roster().member(id).boots;
  const auto [known, is_first] = boots_.emplace(id, boots);
  return is_first || std::exchange(known->second, boots) == boots || tell(Event::restarted, now);
}

/// What it refuses to tell is said once; what was known of that stays.
void Watch::tell_refusal(FaultState& now, std::span<const Fault> had) {
  if (now.errors.empty()) {
    refusing_.erase(now.snapshot.servo.id);
    return;
  }
  if (refusing_.insert(now.snapshot.servo.id).second && !context_.reporter().has_screen()) {
    context_.reporter().note(now.errors.front().message);
  }
  std::ranges::copy_if(had, std::back_inserter(now.faults),
                       [&](const Fault& fault) { return !now.fault_register(fault.reg); });
}

/// Compares one read of a servo with the one before.
bool Watch::take(FaultState now) {
  if (!tell_silence(now) || (now.has_answered() && !tell_restart(now))) {
    return false;
  }
  const NodeId id = now.snapshot.servo.id;
  auto before = last_.find(id);
  const auto& unit = now.snapshot.servo.unique_id;
  if (before != last_.end() && now.has_answered() && before->second.snapshot.servo.unique_id &&
      before->second.snapshot.servo.unique_id != unit) {
    // The faults of the previous servo did not go: this is another unit.
    context_.reporter().note(say<texts::fault_other_servo>(id.value()));
    last_.erase(before);
    before = last_.end();
  }
  // faults in registers that were unreadable before count as present
  const bool is_first = before == last_.end() || before->second.snapshot.readings.empty();
  if (!now.has_answered() && !is_first) {
    before->second.errors = std::move(now.errors);
    return true;
  }
  const auto had = is_first ? std::vector<Fault>() : before->second.faults;
  if (now.has_answered()) {
    tell_refusal(now, had);
  }
  bool goes_on = true;
  for (const Fault& fault : now.faults) {
    if (std::ranges::find(had, fault) == had.end()) {
      goes_on = goes_on && tell(is_first ? Event::present : Event::came, now, &fault);
    }
  }
  for (const Fault& fault : had) {
    if (std::ranges::find(now.faults, fault) == now.faults.end()) {
      goes_on = goes_on && tell(Event::went, now, &fault);
    }
  }
  last_.insert_or_assign(id, std::move(now));
  return goes_on;
}

/// On a terminal the list is redrawn, instead of a line for each event.
bool Watch::redraw() {
  if (!context_.reporter().has_screen()) {
    return true;
  }
  std::vector<FaultState> servos;
  std::ranges::transform(last_, std::back_inserter(servos),
                         &std::pair<const NodeId, FaultState>::second);
  return check(context_.reporter().show(text(servos, shown_, context_.reporter().page())));
}

bool Watch::take(std::vector<FaultState> seen) {
  bool goes_on = true;
  for (FaultState& servo : seen) {
    goes_on = goes_on && take(std::move(servo));
  }
  return goes_on && redraw();
}

} // namespace

void watch_faults(std::span<const NodeId> servos, bla::Level shown, bla::Level counted,
                  Context& context, Report& report) {
  fleet::Session& session = context.session();
  fleet::FaultWatch looks(session, context.known(), servos, context.identification(), interval);
  Watch watch(shown, context, report);
  for (bool goes_on = true; goes_on;) {
    auto seen = looks.next();
    if (!seen) {
      context.broken(seen.error(), report);
      break;
    }
    goes_on = watch.take(std::move(*seen)) && !session.is_replay();
  }
  for (const auto& [id, servo] : watch.last()) {
    report.targets.push_back({.errors = servo.errors, .has_found = has_found(servo, counted)});
  }
}

} // namespace blactl::cli
