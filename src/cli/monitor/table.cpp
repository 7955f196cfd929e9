#include "cli/monitor/table.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/status_words.hpp"

#include "cli/monitor/sample.hpp"
#include "cli/monitor/texts.hpp"
#include "cli/output/page.hpp"
#include "cli/texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <string_view>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::LiveField;
using fleet::LiveServo;

/// A servo counts as new if it appears this long after the start, and for the same time.
constexpr Duration novelty = std::chrono::seconds(10);

/// The silence of a servo after which the colour shows it.
constexpr Duration silence = std::chrono::seconds(1);

std::string name_of(const bla::Fault& fault) {
  return fault.known != nullptr ? std::string(choose(fault.known->text_en, fault.known->text_ja))
                                : say<texts::state_unknown_fault>(fault.reg.name(), fault.bit);
}

Look look_of(bla::Level level) {
  return level == bla::Level::warning ? Look::warning : Look::bad;
}

/// Notices, such as a missing PWM signal, are normal in most servos.
std::size_t count_worse_than_notices(const LiveServo& servo) {
  return static_cast<std::size_t>(std::ranges::count_if(
      servo.faults, [](const bla::Fault& fault) { return fault.level > bla::Level::notice; }));
}

Look worst_look(const LiveServo& servo) {
  Look look = servo.restarts > 0 ? Look::warning : Look::plain;
  if (servo.status && servo.status->health != dronecan::Health::ok) {
    look = servo.status->health == dronecan::Health::warning ? Look::warning : Look::bad;
  }
  return count_worse_than_notices(servo) == 0 ? look
                                              : std::max(look, look_of(servo.faults.front().level));
}

std::int64_t whole_seconds_since(Time then, Time now) {
  return std::chrono::duration_cast<std::chrono::seconds>(now - then).count();
}

/// The order with the worst first.
int rank(const LiveServo& servo) {
  if (servo.is_doubled) {
    return 0;
  }
  const int level = servo.faults.empty() ? 0 : static_cast<int>(servo.faults[0].level);
  return servo.is_gone ? 1 : 4 - level;
}

std::int64_t number(const LiveServo& servo, LiveField field) {
  const auto& value = servo.value(field);
  return value ? value->raw : std::numeric_limits<std::int64_t>::min();
}

/// Servos without a temperature come last.
std::int64_t hottest_first(const LiveServo& servo) {
  const auto& value = servo.value(LiveField::temperature);
  return value ? -value->raw : std::numeric_limits<std::int64_t>::max();
}

std::string left(const std::string& text, std::size_t width) {
  const std::size_t cells = display_width(text);
  return text + std::string(width - std::min(width, cells), ' ');
}

constexpr std::size_t node_width = 4, model_width = 13, age_width = 7;

ScreenLine header() {
  std::string line = right_aligned(say<texts::column_node>(), node_width) + "  " +
                     left(say<texts::column_model>(), model_width);
  for (const Measured& each : measured) {
    line += right_aligned(std::string(each.unit), each.width);
  }
  line += right_aligned(say<texts::monitor_age>(), age_width) + "  " + say<texts::column_state>();
  return {{line, Look::head}};
}

ScreenLine row(const LiveServo& servo, Time now, Time begin, bool is_chosen) {
  const bool is_old = servo.is_stale || now - servo.last_heard > silence;
  const Look look = servo.has_turned ? Look::lit
                    : is_chosen      ? Look::chosen
                    : is_old         ? Look::dim
                                     : Look::plain;
  std::string line = right_aligned(std::to_string(servo.servo.id.value()), node_width) + "  " +
                     left(servo.servo.identity.model(), model_width);
  for (const Measured& each : measured) {
    const std::string text = live_text(servo, each.field);
    line += right_aligned(text.empty() ? "-" : text, each.width);
  }
  const double age = std::chrono::duration<double>(now - servo.last_heard).count();
  line += right_aligned(fmt::format("{:.1f} s", std::max(age, 0.0)), age_width) + "  ";
  Piece state = state_of(servo, now, begin);
  return servo.has_turned
             ? ScreenLine{{line + say<texts::state_turned>(), look}, {"  "}, std::move(state)}
             : ScreenLine{{line, look}, std::move(state)};
}

} // namespace

std::string faults_of(const LiveServo& servo) {
  const std::size_t count = count_worse_than_notices(servo);
  if (count == 0) {
    const bool is_ill = servo.status && servo.status->health != dronecan::Health::ok;
    return is_ill ? fleet::health_word(servo.status->health) : std::string();
  }
  std::string out = name_of(servo.faults.front());
  if (count > 1) {
    out += ' ' + say<texts::state_more>(count - 1);
  }
  return out;
}

Piece state_of(const LiveServo& servo, Time now, Time begin) {
  if (servo.is_doubled) {
    return {say<texts::state_doubled>(), Look::bad};
  }
  if (servo.is_gone) {
    return {say<texts::state_gone>(whole_seconds_since(servo.last_heard, now)), Look::bad};
  }
  std::string out = faults_of(servo);
  const auto add = [&out](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (servo.restarts > 0) {
    add(say<texts::state_restarts>(servo.restarts));
  }
  if (servo.former_id) {
    add(say<texts::state_former>(servo.former_id->value()));
  } else if (servo.first_heard - begin > novelty && now - servo.first_heard < novelty) {
    add(say<texts::state_new>());
  }
  return {std::move(out), worst_look(servo)};
}

/// A servo that has begun to turn, wherever it is, becomes the chosen one.
void MonitorTable::follow(const std::vector<LiveServo>& servos) {
  for (const LiveServo& servo : servos) {
    const auto before = std::ranges::find(servos_, servo.servo.id,
                                          [](const LiveServo& each) { return each.servo.id; });
    if (servo.has_turned && (before == servos_.end() || !before->has_turned)) {
      chosen_ = servo.servo.id;
    }
  }
}

void MonitorTable::take(std::vector<LiveServo> servos) {
  follow(servos);
  servos_ = std::move(servos);
  sort();
  const bool is_there = chosen_ && std::ranges::any_of(servos_, [this](const LiveServo& servo) {
                          return servo.servo.id == *chosen_;
                        });
  if (!is_there) {
    chosen_ = servos_.empty() ? std::nullopt : std::optional(servos_.front().servo.id);
  }
}

void MonitorTable::sort() {
  const auto key = [this](const LiveServo& servo) -> std::int64_t {
    switch (order_) {
    case Order::node: return servo.servo.id.value();
    case Order::state: return rank(servo);
    case Order::angle: return number(servo, LiveField::angle);
    case Order::temperature: return hottest_first(servo);
    case Order::voltage: break;
    }
    return number(servo, LiveField::voltage);
  };
  std::ranges::stable_sort(servos_, {}, key);
}

std::size_t MonitorTable::place() const {
  const auto it = std::ranges::find_if(
      servos_, [this](const LiveServo& servo) { return chosen_ && servo.servo.id == *chosen_; });
  return it != servos_.end() ? static_cast<std::size_t>(it - servos_.begin()) : 0;
}

const LiveServo* MonitorTable::chosen() const {
  return servos_.empty() ? nullptr : &servos_[place()];
}

void MonitorTable::move(std::ptrdiff_t by) {
  if (servos_.empty()) {
    return;
  }
  const auto last = static_cast<std::ptrdiff_t>(servos_.size()) - 1;
  const auto to = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(place()) + by, 0, last);
  chosen_ = servos_[static_cast<std::size_t>(to)].servo.id;
}

bool MonitorTable::press(Key key) {
  const auto page = static_cast<std::ptrdiff_t>(rows_);
  const auto all = static_cast<std::ptrdiff_t>(servos_.size());
  switch (key) {
  case keys::up:
  case U'k': move(-1); return true;
  case keys::down:
  case U'j': move(1); return true;
  case keys::page_up: move(-page); return true;
  case keys::page_down: move(page); return true;
  case keys::home: move(-all); return true;
  case keys::end: move(all); return true;
  case U's':
    order_ =
        order_ == Order::voltage ? Order::node : static_cast<Order>(static_cast<int>(order_) + 1);
    sort();
    return true;
  default: return false;
  }
}

std::string MonitorTable::order() const {
  switch (order_) {
  case Order::node: return say<texts::sort_node>();
  case Order::state: return say<texts::sort_state>();
  case Order::angle: return say<texts::sort_angle>();
  case Order::temperature: return say<texts::sort_temperature>();
  case Order::voltage: break;
  }
  return say<texts::sort_voltage>();
}

std::vector<ScreenLine> MonitorTable::lines(std::size_t height, Time now) {
  rows_ = std::max<std::size_t>(height, 2) - 1;
  const std::size_t at = place();
  const std::size_t most_top = servos_.size() > rows_ ? servos_.size() - rows_ : 0;
  top_ = std::min({top_, at, most_top});
  top_ = at >= top_ + rows_ ? at - rows_ + 1 : top_;
  const std::size_t end = std::min(servos_.size(), top_ + rows_);
  shown_ = servos_.size() > rows_ ? say<texts::monitor_rows>(top_ + 1, end, servos_.size())
                                  : std::string();
  std::vector<ScreenLine> out{header()};
  for (std::size_t i = top_; i < end; ++i) {
    out.push_back(row(servos_[i], now, begin_, i == at));
  }
  if (servos_.empty()) {
    out.push_back({{"  " + say<texts::monitor_waiting>(), Look::dim}});
  }
  return out;
}

} // namespace blactl::cli
