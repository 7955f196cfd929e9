#include "cli/faults/watch.hpp"

#include "blactl/fleet/bus/status_words.hpp"
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
  std::string (*text)();
};

/// In the order of Event.
constexpr EventName event_names[]{
    {"present", [] { return say<texts::fault_present>(); }},
    {"came", [] { return say<texts::fault_came>(); }},
    {"went", [] { return say<texts::fault_went>(); }},
    {"restarted", [] { return say<texts::servo_restarted>(); }},
    {"gone", [] { return say<texts::servo_gone>(); }},
    {"back", [] { return say<texts::servo_back_again>(); }},
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
  [[nodiscard]] bool print_json(Event event, const FaultState& servo, const Fault* fault);
  [[nodiscard]] bool print_text(const FaultState& servo, const std::string& word,
                                const std::string& detail);

  [[nodiscard]] bool is_for_people() const { return context_.reporter().format() == Format::text; }

  [[nodiscard]] bool tell_first(const FaultState& now);
  [[nodiscard]] bool tell_restart(const FaultState& now);
  [[nodiscard]] bool check(const Result<bool>& printed);
  [[nodiscard]] bool tell_silence(const FaultState& now);
  [[nodiscard]] bool tell_exchange(const FaultState& now);
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

bool Watch::print_json(Event event, const FaultState& servo, const Fault* fault) {
  const UnixTime time(context_.session().wall());
  std::string line;
  JsonWriter json(line);
  json.begin_object();
  json.key("time");
  json.number(time.text());
  write_head(json, servo.snapshot.servo);
  json.member("event", event_names[std::to_underlying(event)].word);
  if (fault != nullptr) {
    write_fault(json, servo, *fault);
  }
  json.end_object();
  return check(context_.reporter().stream(line + '\n'));
}

bool Watch::print_text(const FaultState& servo, const std::string& word,
                       const std::string& detail) {
  const Reporter& reporter = context_.reporter();
  std::string line = say<texts::fault_event>(clock_text(context_.session().wall()),
                                             servo.snapshot.servo.id.value(), word, detail);
  line.erase(line.find_last_not_of(' ') + 1);
  return check(reporter.stream(reporter.page().fit(line) + '\n'));
}

/// Why a servo is gone, where it is not merely silent.
std::string reason_of(const FaultState& servo) {
  const auto is_silence = [](const Error& error) {
    return error.code == Code::timeout || error.code == Code::not_found;
  };
  return servo.errors.empty() || is_silence(servo.errors.front()) ? ""
                                                                  : servo.errors.front().message;
}

/// `fault`: null for an event of the servo itself.
bool Watch::tell(Event event, const FaultState& servo, const Fault* fault) {
  if (fault != nullptr && fault->level < shown_) {
    return true;
  }
  if (!is_for_people()) {
    return print_json(event, servo, fault);
  }
  return print_text(servo, event_names[std::to_underlying(event)].text(),
                    fault != nullptr ? fault_line(*fault, context_.reporter().page())
                                     : reason_of(servo));
}

/// People also read of a servo without a fault to show, once.
bool Watch::tell_first(const FaultState& now) {
  const bool has_shown =
      std::ranges::any_of(now.faults, [this](const Fault& fault) { return fault.level >= shown_; });
  if (!is_for_people() || !now.has_answered() || has_shown) {
    return true;
  }
  if (now.unexplained_health()) {
    return print_text(now, say<texts::health_unexplained>(fleet::health_word(*now.health)), "");
  }
  return print_text(now,
                    now.faults.empty()
                        ? say<texts::no_faults>()
                        : say<texts::faults_hidden>(now.faults.size(), level_word(shown_)),
                    "");
}

/// A servo that does not respond keeps its last known faults.
bool Watch::tell_silence(const FaultState& now) {
  const NodeId id = now.snapshot.servo.id;
  const bool has_answered = now.has_answered();
  const bool is_news = has_answered ? silent_.erase(id) > 0 : silent_.insert(id).second;
  if (!is_news) {
    return true;
  }
  if (!is_for_people()) {
    context_.reporter().note(has_answered ? say<texts::answers_again>(id.value())
                                          : now.errors.front().message);
  }
  const auto before = last_.find(id);
  if (has_answered || before == last_.end()) {
    return tell(has_answered ? Event::back : Event::gone, now);
  }
  before->second.errors = now.errors;
  return tell(Event::gone, before->second);
}

/// The faults of the servo before did not go, and this one did not restart: it is another unit,
/// with which the node ID is back.
bool Watch::tell_exchange(const FaultState& now) {
  const NodeId id = now.snapshot.servo.id;
  const auto before = last_.find(id);
  const bool is_other = before != last_.end() && now.has_answered() &&
                        before->second.snapshot.servo.unique_id &&
                        before->second.snapshot.servo.unique_id != now.snapshot.servo.unique_id;
  if (!is_other) {
    return true;
  }
  context_.reporter().note(say<texts::fault_other_servo>(id.value()));
  const bool goes_on = !silent_.insert(id).second || tell(Event::gone, before->second);
  last_.erase(before);
  boots_[id] = context_.session().roster().member(id).boots;
  return goes_on;
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
  if (refusing_.insert(now.snapshot.servo.id).second) {
    context_.reporter().note(now.errors.front().message);
  }
  std::ranges::copy_if(had, std::back_inserter(now.faults),
                       [&](const Fault& fault) { return !now.fault_register(fault.reg); });
}

/// Compares one read of a servo with the one before.
bool Watch::take(FaultState now) {
  if (!tell_exchange(now) || !tell_silence(now) || (now.has_answered() && !tell_restart(now))) {
    return false;
  }
  const NodeId id = now.snapshot.servo.id;
  const auto before = last_.find(id);
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
  bool goes_on = !is_first || tell_first(now);
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

bool Watch::take(std::vector<FaultState> seen) {
  bool goes_on = true;
  for (FaultState& servo : seen) {
    goes_on = goes_on && take(std::move(servo));
  }
  return goes_on;
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
      context.ended(seen.error(), report);
      break;
    }
    goes_on = watch.take(std::move(*seen)) && !session.is_replay();
  }
  for (const auto& [id, servo] : watch.last()) {
    report.targets.push_back({.errors = servo.errors, .has_found = has_found(servo, counted)});
  }
}

} // namespace blactl::cli
