// A command to a shaft as a drawing of target and motion.

#include "cli/output/svg.hpp"

#include "blactl/bla/value.hpp"

#include "cli/motion/sample.hpp"
#include "cli/motion/texts.hpp"
#include "cli/output/node_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {
namespace {

using fleet::CommandReading;
using fleet::MotionPlan;
using fleet::MotionResult;
using fleet::MotionSample;

/// An A4 page in portrait, in points, with three panels.
constexpr double page_width = 595, page_height = 842;
constexpr double left_edge = 70, right_edge = 560, first_top = 70, panel_height = 205,
                 panel_step = 245;

constexpr std::string_view grid = "stroke=\"#ccc\" stroke-width=\"0.7\"";
constexpr std::string_view measured = "stroke=\"#06c\" stroke-width=\"1.5\"";
constexpr std::string_view commanded =
    "stroke=\"#c00\" stroke-width=\"1\" stroke-dasharray=\"4 3\"";
constexpr std::string_view limit = "stroke=\"#080\" stroke-width=\"0.7\"";

struct Panel {
  const CommandReading& reading;
  std::optional<std::int64_t> MotionSample::* value;
  bool is_commanded; ///< the target is of this quantity
  std::string title;
  double top;
};

class MotionDrawing {
 public:
  MotionDrawing(const MotionPlan& plan, const MotionResult& result, std::string_view title)
      : plan_(plan), samples_(result.samples), svg_(page_width, page_height, title) {
    svg_.label({left_edge, first_top - 38}, "start", title);
    svg_.label({left_edge, first_top - 22}, "start", say<texts::motion_legend>());
  }

  [[nodiscard]] std::string text();

 private:
  void draw(const Panel& panel);
  void scale(const Panel& panel);
  void limits(const Panel& panel);
  void fit(const Panel& panel);

  [[nodiscard]] double x(Time at) const {
    const auto all = static_cast<double>(
        std::max<std::int64_t>((samples_.back().at - samples_.front().at).count(), 1));
    return left_edge +
           static_cast<double>((at - samples_.front().at).count()) / all * (right_edge - left_edge);
  }

  [[nodiscard]] double y(const Panel& panel, std::int64_t raw) const {
    const double part = static_cast<double>(raw - low_) /
                        static_cast<double>(std::max<std::int64_t>(high_ - low_, 1));
    return panel.top + panel_height * (1 - part);
  }

  const MotionPlan& plan_;
  const std::vector<MotionSample>& samples_;
  Svg svg_;
  std::int64_t low_ = 0, high_ = 0; ///< of the present panel
};

/// Fits the scale to readings, targets and zero; to limits only if they are near.
void MotionDrawing::fit(const Panel& panel) {
  low_ = high_ = 0;
  for (const MotionSample& sample : samples_) {
    for (const auto& raw :
         {sample.*panel.value, panel.is_commanded ? std::optional(sample.target) : std::nullopt}) {
      low_ = std::min(low_, raw.value_or(low_));
      high_ = std::max(high_, raw.value_or(high_));
    }
  }
  const std::int64_t margin = std::max<std::int64_t>((high_ - low_) / 10, 5);
  low_ -= margin;
  high_ += margin;
}

/// 1, 2 or 5 times a power of ten, so that at most six of them fit into the span.
std::int64_t round_step(std::int64_t span) {
  constexpr std::int64_t most = 6;
  for (std::int64_t power = 1;; power *= 10) {
    for (const std::int64_t digit : {1, 2, 5}) {
      if (span / (digit * power) <= most) {
        return digit * power;
      }
    }
  }
}

void MotionDrawing::scale(const Panel& panel) {
  const auto& parameter = *panel.reading.parameter;
  const double bottom = panel.top + panel_height;
  const std::int64_t step = round_step(high_ - low_);
  for (std::int64_t raw = low_ / step * step; raw <= high_; raw += step) {
    if (raw >= low_) {
      svg_.line({left_edge, y(panel, raw)}, {right_edge, y(panel, raw)}, grid);
      svg_.label({left_edge - 6, y(panel, raw) + 4}, "end", bla::value_text(parameter, raw));
    }
  }
  const Time begin = samples_.front().at;
  const Duration tick(round_step((samples_.back().at - begin).count()));
  for (Time at = begin; at <= samples_.back().at; at += tick) {
    svg_.line({x(at), panel.top}, {x(at), bottom}, grid);
    svg_.label({x(at), bottom + 14}, "middle",
               fmt::format("{:g}", std::chrono::duration<double>(at - begin).count()));
  }
}

/// Limits outside the scale are only written as text.
void MotionDrawing::limits(const Panel& panel) {
  std::string title = panel.title;
  if (panel.reading.low && panel.reading.high) {
    title += "    " +
             say<texts::motion_limits>(bla::display(*panel.reading.parameter, *panel.reading.low),
                                       bla::display(*panel.reading.parameter, *panel.reading.high));
  }
  svg_.label({left_edge, panel.top - 5}, "start", title);
  for (const auto& raw : {panel.reading.low, panel.reading.high}) {
    if (raw && *raw >= low_ && *raw <= high_) {
      svg_.line({left_edge, y(panel, *raw)}, {right_edge, y(panel, *raw)}, limit);
    }
  }
}

void MotionDrawing::draw(const Panel& panel) {
  fit(panel);
  scale(panel);
  limits(panel);
  std::vector<SvgPoint> way, told;
  for (const MotionSample& sample : samples_) {
    if (panel.is_commanded) { // it holds until the next one
      if (!told.empty()) {
        told.push_back({x(sample.at), told.back().y});
      }
      told.push_back({x(sample.at), y(panel, sample.target)});
    }
    if (const auto& raw = sample.*panel.value) {
      way.push_back({x(sample.at), y(panel, *raw)});
    }
  }
  svg_.path(told, commanded);
  svg_.path(way, measured);
}

std::string MotionDrawing::text() {
  const auto& [angle, speed, torque] = plan_.readings;
  const auto is_commanded = [this](const CommandReading& reading) {
    return bla::unit_text(*reading.parameter) == bla::unit_text(*plan_.parameter);
  };
  draw({angle, &MotionSample::angle, is_commanded(angle), say<texts::motion_axis_angle>(),
        first_top});
  draw({speed, &MotionSample::speed, is_commanded(speed), say<texts::motion_axis_speed>(),
        first_top + panel_step});
  draw({torque, &MotionSample::torque, is_commanded(torque), say<texts::motion_axis_torque>(),
        first_top + 2 * panel_step});
  svg_.label({right_edge, first_top + 3 * panel_step - 5}, "end", say<texts::motion_axis_time>());
  return svg_.text();
}

} // namespace

std::string motion_svg(const MotionPlan& plan, const MotionResult& result) {
  std::string title = head_line(plan.servo());
  title.erase(title.find_last_not_of('\n') + 1);
  return MotionDrawing(plan, result, title).text();
}

} // namespace blactl::cli
