// A sample of one servo as a line of text.

#include "blactl/fleet/bus/status_words.hpp"

#include "cli/monitor/sample.hpp"
#include "cli/monitor/table.hpp"
#include "cli/monitor/texts.hpp"
#include "cli/output/page.hpp"
#include "cli/texts.hpp"
#include "cli/trace/time.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace blactl::cli {
namespace {

using fleet::LiveServo;

constexpr std::size_t width_of_time = 12, width_of_node = 6;

bool has(const SampleFields& fields, SampleField field) {
  return std::ranges::find(fields, field) != fields.end();
}

bool shows(const SampleFields& fields, const Measured& measured) {
  return std::ranges::any_of(
      fields, [&](SampleField field) { return live_field(field) == measured.field; });
}

bool shows_state(const SampleFields& fields) {
  using enum SampleField;
  return std::ranges::any_of(fields, [](SampleField field) {
    return field == mode || field == health || field == faults || field == stale || field == moved;
  });
}

/// What the fields ask for, in words; the usual mode goes without one beside another word.
std::string words_of(const LiveServo& servo, const SampleFields& fields) {
  std::string words;
  const auto add = [&](const std::string& word) {
    words += (words.empty() || word.empty() ? "" : ", ") + word;
  };
  if (servo.is_gone) {
    return fleet::mode_word(dronecan::Mode::offline);
  }
  if (servo.is_doubled) {
    return say<texts::state_doubled>();
  }
  if (servo.status && has(fields, SampleField::mode) &&
      servo.status->mode != dronecan::Mode::operational) {
    add(fleet::mode_word(servo.status->mode));
  }
  const std::string faults = has(fields, SampleField::faults) ? faults_of(servo) : std::string();
  add(faults);
  if (faults.empty() && servo.status && has(fields, SampleField::health)) {
    add(fleet::health_word(servo.status->health));
  }
  if (servo.is_stale && has(fields, SampleField::stale)) {
    add(say<texts::state_stale>());
  }
  if (servo.has_turned && has(fields, SampleField::moved)) {
    add(say<texts::state_turned>());
  }
  const bool is_usual = words.empty() && servo.status && has(fields, SampleField::mode);
  return is_usual ? fleet::mode_word(servo.status->mode) : words;
}

/// "14:30:52.249", in the time zone of this process.
std::string time_of_day(WallTime time) {
  constexpr std::size_t date = std::string_view("2015-07-09 ").size();
  const std::string whole = wall_text(time);
  return whole.size() > date ? whole.substr(date, width_of_time) : whole;
}

} // namespace

std::string text_header(const SampleFields& fields) {
  const std::string time = say<texts::monitor_time>();
  std::string line = time + std::string(width_of_time - display_width(time), ' ') + ' ' +
                     right_aligned(say<texts::column_node>(), width_of_node);
  for (const Measured& each : measured) {
    line += shows(fields, each) ? right_aligned(std::string(each.unit), each.width) : "";
  }
  return line + (shows_state(fields) ? "  " + say<texts::column_state>() : "") + '\n';
}

std::string text_sample(WallTime time, const LiveServo& servo, const SampleFields& fields) {
  std::string line = right_aligned(time_of_day(time), width_of_time) + ' ' +
                     right_aligned(std::to_string(servo.servo.id.value()), width_of_node);
  for (const Measured& each : measured) {
    const std::string text = live_text(servo, each.field);
    line += shows(fields, each) ? right_aligned(text.empty() ? "-" : text, each.width) : "";
  }
  return line + (shows_state(fields) ? "  " + words_of(servo, fields) : "") + '\n';
}

} // namespace blactl::cli
