#include "cli/monitor/sample.hpp"

#include "blactl/base/json_writer.hpp"
#include "blactl/bla/value.hpp"

#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/trace/time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::LiveField;
using fleet::LiveServo;

std::optional<std::string_view> mode_of(const LiveServo& servo) {
  if (servo.is_gone) {
    return name(dronecan::Mode::offline);
  }
  return servo.status && !servo.is_doubled ? std::optional(name(servo.status->mode)) : std::nullopt;
}

std::optional<std::string_view> health_of(const LiveServo& servo) {
  return servo.status && !servo.is_doubled ? std::optional(name(servo.status->health))
                                           : std::nullopt;
}

/// The bare value of a field, without quotes or null; empty: unknown.
std::string cell(WallTime time, const LiveServo& servo, SampleField field) {
  if (const auto live = live_field(field)) {
    return live_text(servo, *live);
  }
  switch (field) {
  case SampleField::time: return std::string(UnixTime(time).text());
  case SampleField::mode: return std::string(mode_of(servo).value_or(""));
  case SampleField::health: return std::string(health_of(servo).value_or(""));
  case SampleField::moved: return servo.has_turned ? "true" : "false";
  default: break;
  }
  return servo.is_stale || servo.is_gone ? "true" : "false";
}

std::string_view key(SampleField field) {
  return sample_keys[static_cast<std::size_t>(field)];
}

void write(JsonWriter& json, SampleField field, std::string_view text) {
  json.key(key(field));
  if (text.empty()) {
    json.value(nullptr);
  } else if (field == SampleField::mode || field == SampleField::health) {
    json.value(text);
  } else {
    json.number(text); // or true, or false
  }
}

} // namespace

std::optional<LiveField> live_field(SampleField field) {
  switch (field) {
  case SampleField::angle: return LiveField::angle;
  case SampleField::speed: return LiveField::speed;
  case SampleField::torque: return LiveField::torque;
  case SampleField::temperature: return LiveField::temperature;
  case SampleField::voltage: return LiveField::voltage;
  case SampleField::faults: return LiveField::faults;
  case SampleField::time:
  case SampleField::mode:
  case SampleField::health:
  case SampleField::stale:
  case SampleField::moved: break;
  }
  return std::nullopt;
}

std::string live_text(const LiveServo& servo, LiveField field) {
  const auto& value = servo.value(field);
  const bla::Parameter* parameter = servo.parameter(field);
  return value && parameter != nullptr ? bla::value_text(*parameter, value->raw) : std::string();
}

SampleFields all_sample_fields(bool with_moved) {
  SampleFields all;
  for (std::size_t i = 0; i < sample_keys.size(); ++i) {
    if (const auto field = static_cast<SampleField>(i); field != SampleField::moved || with_moved) {
      all.push_back(field);
    }
  }
  return all;
}

std::vector<LiveField> live_fields_of(const SampleFields& fields) {
  std::vector<LiveField> out;
  for (const SampleField field : fields) {
    if (const auto live = live_field(field)) {
      out.push_back(*live);
    }
  }
  return out;
}

std::string json_sample(WallTime time, const LiveServo& servo, const SampleFields& fields) {
  std::string line;
  JsonWriter json(line);
  json.begin_object();
  write(json, SampleField::time, cell(time, servo, SampleField::time));
  write_head(json, servo.servo);
  for (const SampleField field : fields) {
    if (field != SampleField::time) {
      write(json, field, cell(time, servo, field));
    }
  }
  json.end_object();
  return line + '\n';
}

std::string csv_header(const SampleFields& fields) {
  std::vector<std::string> columns{std::string(key(SampleField::time))};
  std::ranges::move(head_columns(), std::back_inserter(columns));
  for (const SampleField field : fields) {
    if (field != SampleField::time) {
      columns.emplace_back(key(field));
    }
  }
  return csv_line(columns);
}

std::string csv_sample(WallTime time, const LiveServo& servo, const SampleFields& fields) {
  std::vector<std::string> cells{cell(time, servo, SampleField::time)};
  std::ranges::move(head_cells(servo.servo), std::back_inserter(cells));
  for (const SampleField field : fields) {
    if (field != SampleField::time) {
      cells.push_back(cell(time, servo, field));
    }
  }
  return csv_line(cells);
}

} // namespace blactl::cli
