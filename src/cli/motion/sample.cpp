#include "cli/motion/sample.hpp"

#include "blactl/base/json_writer.hpp"
#include "blactl/bla/value.hpp"

#include "cli/motion/texts.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/trace/time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using fleet::MotionPlan;
using fleet::MotionSample;
using Raw = std::optional<std::int64_t>;

constexpr std::array<std::string_view, 3> motion_keys{"angle_deg", "speed_rpm", "torque_pct"};

/// The numbers of a sample in their units, in the order of the keys; empty: no response.
std::array<std::string, 3> numbers(const MotionPlan& plan, const MotionSample& sample) {
  std::array<std::string, 3> out;
  const std::array<Raw, 3> raws{sample.angle, sample.speed, sample.torque};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (raws.at(i)) {
      out.at(i) = bla::value_text(*plan.readings.at(i).parameter, *raws.at(i));
    }
  }
  return out;
}

/// The read value farthest from 0.
std::string most(const MotionPlan& plan, const fleet::MotionResult& result, std::size_t reading,
                 Raw MotionSample::* member) {
  std::int64_t found = 0;
  for (const MotionSample& sample : result.samples) {
    const std::int64_t raw = (sample.*member).value_or(0);
    found = std::abs(raw) > std::abs(found) ? raw : found;
  }
  return bla::display(*plan.readings.at(reading).parameter, found);
}

std::string place(const MotionPlan& plan, const fleet::MotionResult& result) {
  for (auto sample = result.samples.rbegin(); sample != result.samples.rend(); ++sample) {
    if (sample->angle) {
      return bla::display(*plan.readings.front().parameter, *sample->angle);
    }
  }
  return "?";
}

} // namespace

std::string json_motion(WallTime time, const MotionPlan& plan, const MotionSample& sample) {
  std::string line;
  JsonWriter json(line);
  json.begin_object();
  json.key("time");
  json.number(UnixTime(time).text());
  write_head(json, plan.servo());
  const auto values = numbers(plan, sample);
  for (std::size_t i = 0; i < values.size(); ++i) {
    json.key(motion_keys.at(i));
    values.at(i).empty() ? json.value(nullptr) : json.number(values.at(i));
  }
  json.member(plan.parameter->name, sample.target);
  json.end_object();
  return line + '\n';
}

std::string csv_motion_header(const MotionPlan& plan) {
  std::vector<std::string> columns{"time"};
  std::ranges::move(head_columns(), std::back_inserter(columns));
  columns.insert(columns.end(), motion_keys.begin(), motion_keys.end());
  columns.push_back(plan.parameter->name);
  return csv_line(columns);
}

std::string csv_motion(WallTime time, const MotionPlan& plan, const MotionSample& sample) {
  std::vector<std::string> cells{std::string(UnixTime(time).text())};
  std::ranges::move(head_cells(plan.servo()), std::back_inserter(cells));
  std::ranges::move(numbers(plan, sample), std::back_inserter(cells));
  cells.push_back(std::to_string(sample.target));
  return csv_line(cells);
}

std::string text_motion_header(const MotionPlan& plan) {
  return fmt::format("{:>8}  {:>14}  {:>11}  {:>9}  {:>10}\n", "time_s", plan.parameter->name,
                     motion_keys[0], motion_keys[1], motion_keys[2]);
}

std::string text_motion(const MotionPlan& plan, const MotionSample& sample) {
  auto values = numbers(plan, sample);
  for (std::string& value : values) {
    value = value.empty() ? "-" : value;
  }
  return fmt::format("{:>8.3f}  {:>14}  {:>11}  {:>9}  {:>10}\n",
                     std::chrono::duration<double>(sample.after).count(),
                     bla::display(*plan.parameter, sample.target), values[0], values[1], values[2]);
}

std::string motion_summary(const MotionPlan& plan, const fleet::MotionResult& result) {
  const std::uint8_t id = plan.servo().id.value();
  const std::string where = place(plan, result);
  constexpr std::int64_t brake = 2; // 4.13
  const bool is_braked = result.output == brake && !result.protection;
  std::string text =
      !fleet::holds(plan, result) && is_braked ? say<texts::motion_braked>(id, where)
      : !fleet::holds(plan, result)            ? say<texts::motion_loose>(id, where)
      : plan.is_angle()
          ? say<texts::motion_held>(
                id, bla::display(*plan.parameter, result.held.value_or(plan.last_target())), where)
          : say<texts::motion_stopped>(id, where);
  const auto response = fleet::step_response(plan, result);
  if (plan.is_angle() && !plan.wiggles() && !result.held && response.settled) {
    const double settled = std::chrono::duration<double>(*response.settled).count();
    text += "; " +
            say<texts::motion_settled>(fmt::format("{:.2f}", settled),
                                       bla::display(*plan.parameter, response.overshoot_decideg));
  }
  text += "; " + say<texts::motion_extremes>(most(plan, result, 1, &MotionSample::speed),
                                             most(plan, result, 2, &MotionSample::torque));
  return text + "; " + fleet::after_commands(plan, result);
}

} // namespace blactl::cli
