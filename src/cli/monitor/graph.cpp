#include "cli/monitor/graph.hpp"

#include "blactl/bla/value.hpp"

#include "cli/monitor/sample.hpp"
#include "cli/monitor/texts.hpp"
#include "cli/output/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace blactl::cli {
namespace {

using fleet::LiveField;
using fleet::LiveServo;
using Points = std::vector<MonitorHistory::Point>;

constexpr std::size_t scale_width = 12;

/// The least height of a graph: a title, and some lines.
constexpr std::size_t least_height = 5;

/// The least span of a scale, in raw values, so that noise does not look like motion.
constexpr std::int64_t least_span = 20;

struct Scale {
  std::int64_t low = 0, high = 0;
};

Scale scale_of(const Points& points) {
  const auto [least, most] = std::ranges::minmax(points, {}, &MonitorHistory::Point::second);
  const std::int64_t margin =
      std::max((most.second - least.second) / 10, (least_span - (most.second - least.second)) / 2);
  return {least.second - std::max<std::int64_t>(margin, 1),
          most.second + std::max<std::int64_t>(margin, 1)};
}

/// Dots on a grid finer than the terminal's cells: two by four per cell with Unicode's Braille
/// patterns, else one.
class Canvas {
 public:
  Canvas(std::size_t height, std::size_t width, bool unicode)
      : across_(unicode ? 2 : 1), down_(unicode ? 4 : 1), height_(height), width_(width),
        cells_(height * width), rules_(height) {}

  /// In dots.
  [[nodiscard]] std::size_t height() const { return height_ * down_; }

  [[nodiscard]] std::size_t width() const { return width_ * across_; }

  void dot(std::size_t row, std::size_t column) {
    // Bits of a Braille pattern: two columns of three dots, then one row of two (Unicode, U+2800).
    constexpr std::array<std::array<std::uint8_t, 2>, 4> bits{
        {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}}};
    auto& cell = cells_[row / down_ * width_ + column / across_];
    cell = static_cast<std::uint8_t>(cell | bits[row % down_][column % across_]);
  }

  /// A horizontal line behind the dots.
  void rule(std::size_t row) { rules_[row / down_] = true; }

  [[nodiscard]] std::string line(std::size_t row) const {
    std::string out;
    for (std::size_t column = 0; column < width_; ++column) {
      const std::uint8_t cell = cells_[row * width_ + column];
      if (cell == 0) {
        out += rules_[row] ? (down_ > 1 ? "┄" : "-") : " ";
      } else if (down_ == 1) {
        out += '*';
      } else { // U+2800 plus the pattern, in UTF-8
        out +=
            {'\xE2', static_cast<char>(0xA0 | cell >> 6), static_cast<char>(0x80 | (cell & 0x3F))};
      }
    }
    return out;
  }

 private:
  std::size_t across_, down_, height_, width_;
  std::vector<std::uint8_t> cells_;
  std::vector<bool> rules_;
};

/// The row of a value, the highest one at the top; empty: outside the scale.
std::optional<std::size_t> row_of(std::int64_t value, const Scale& scale, std::size_t rows) {
  if (value < scale.low || value > scale.high) {
    return std::nullopt;
  }
  const auto last = static_cast<std::int64_t>(rows) - 1;
  return static_cast<std::size_t>((scale.high - value) * last / (scale.high - scale.low));
}

/// The newest sample is at the right. Steps are drawn, as nothing is known between samples.
void plot(const Points& points, const Scale& scale, Time now, Canvas& canvas) {
  for (const auto& [at, value] : points) {
    const auto age = std::min<Duration>(now - at, MonitorHistory::span);
    const auto columns = static_cast<std::int64_t>(canvas.width()) - 1;
    const auto back = age.count() * columns / MonitorHistory::span.count();
    if (const auto row = row_of(value, scale, canvas.height())) {
      canvas.dot(*row, static_cast<std::size_t>(columns - back));
    }
  }
}

std::string header_of(LiveField field) {
  switch (field) {
  case LiveField::angle: return say<texts::monitor_angle>();
  case LiveField::speed: return say<texts::monitor_speed>();
  case LiveField::torque: return say<texts::monitor_torque>();
  case LiveField::temperature: return say<texts::monitor_temperature>();
  case LiveField::voltage: return say<texts::monitor_voltage>();
  case LiveField::faults: break;
  }
  return {};
}

/// Draws a title, and `height` - 1 lines below it.
void draw(const LiveServo& servo, LiveField field, const Points& points, Time now,
          std::size_t height, std::size_t width, bool unicode, std::vector<ScreenLine>& out) {
  const bla::Parameter& parameter = *servo.parameter(field);
  const auto text = [&parameter](std::int64_t raw) { return bla::display(parameter, raw); };
  if (points.empty()) {
    out.push_back({{header_of(field), Look::head}, {"  " + say<texts::graph_empty>(), Look::dim}});
    return;
  }
  const auto [least, most] = std::ranges::minmax(points, {}, &MonitorHistory::Point::second);
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(MonitorHistory::span);
  out.push_back({{header_of(field), Look::head},
                 {"  " + say<texts::graph_range>(seconds.count(), text(points.back().second),
                                                 text(least.second), text(most.second))}});
  const Scale scale = scale_of(points);
  Canvas canvas(height - 1, width - scale_width, unicode);
  const fleet::LiveLimits& limits = servo.limits[static_cast<std::size_t>(field)];
  for (const auto& limit : {limits.low, limits.high}) {
    if (const auto row = limit ? row_of(*limit, scale, canvas.height()) : std::nullopt) {
      canvas.rule(*row);
    }
  }
  plot(points, scale, now, canvas);
  for (std::size_t row = 0; row + 1 < height; ++row) {
    const std::string mark = row == 0            ? text(scale.high)
                             : row + 2 == height ? text(scale.low)
                                                 : std::string();
    const std::size_t blanks = scale_width - 1 - std::min(display_width(mark), scale_width - 1);
    out.push_back({{std::string(blanks, ' ') + mark + ' ', Look::dim}, {canvas.line(row)}});
  }
}

} // namespace

void MonitorHistory::take(const std::vector<LiveServo>& servos, Time now) {
  for (const LiveServo& servo : servos) {
    Moment moment{.at = now};
    for (std::size_t field = 0; field < fleet::live_fields; ++field) {
      const auto& value = servo.values[field];
      moment.values[field] = value && !servo.is_gone ? std::optional(value->raw) : std::nullopt;
    }
    auto& moments = moments_[servo.servo.id];
    moments.push_back(moment);
    while (now - moments.front().at > span) {
      moments.pop_front();
    }
  }
}

Points MonitorHistory::points(dronecan::NodeId id, LiveField field) const {
  Points out;
  if (const auto it = moments_.find(id); it != moments_.end()) {
    for (const Moment& moment : it->second) {
      if (const auto& value = moment.values[static_cast<std::size_t>(field)]) {
        out.emplace_back(moment.at, *value);
      }
    }
  }
  return out;
}

std::vector<ScreenLine> graphs(const LiveServo& servo, const MonitorHistory& history, Time now,
                               std::size_t height, std::size_t width, bool unicode) {
  constexpr std::array fields{LiveField::angle, LiveField::speed, LiveField::torque,
                              LiveField::temperature, LiveField::voltage};
  std::vector<ScreenLine> out;
  const std::size_t count = std::clamp<std::size_t>(height / least_height, 1, fields.size());
  for (std::size_t i = 0; i < count && width > scale_width; ++i) {
    draw(servo, fields[i], history.points(servo.servo.id, fields[i]), now, height / count, width,
         unicode, out);
  }
  return out;
}

} // namespace blactl::cli
