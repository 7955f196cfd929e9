#include "blactl/base/text.hpp"

#include "cli/output/pwm_view.hpp"
#include "cli/output/svg.hpp"
#include "cli/pwm_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace blactl::cli {
namespace {

using bla::PwmMapping;

/// An A5 page in landscape, in points.
constexpr double width = 595, height = 420;
constexpr double left = 80, right = 560, top = 60, bottom = 350;

class Drawing {
 public:
  Drawing(const PwmMapping& mapping, std::string_view title)
      : mapping_(mapping), svg_(width, height, title) {}

  [[nodiscard]] std::string text(std::string_view title);

 private:
  [[nodiscard]] double x(std::int64_t pulse) const {
    const auto span = static_cast<double>(std::max<std::int64_t>(2 * mapping_.range_us, 1));
    return left + static_cast<double>(pulse - mapping_.shortest_us()) / span * (right - left);
  }

  [[nodiscard]] double y(std::int64_t command) const {
    const auto most = static_cast<double>(std::max<std::int64_t>(mapping_.output_raw, 1));
    return (top + bottom) / 2 - static_cast<double>(command) / most * (bottom - top) / 2;
  }

  void curve();
  void axes();
  void points();

  const PwmMapping& mapping_;
  Svg svg_;
};

void Drawing::axes() {
  constexpr std::string_view thin = "stroke=\"#999\" stroke-width=\"0.7\"";
  const double neutral = x(mapping_.neutral_us);
  svg_.line({left, y(0)}, {right, y(0)}, thin);
  svg_.line({neutral, top}, {neutral, bottom}, thin);
  for (const std::int64_t command : {mapping_.output_raw, std::int64_t{0}, -mapping_.output_raw}) {
    svg_.label({left - 8, y(command) + 4}, "end", pwm_command_text(mapping_, command));
  }
}

/// The command, and as a thicker line the part within the limits.
void Drawing::curve() {
  const std::int64_t first = mapping_.points_us().front();
  svg_.line({x(first), y(mapping_.command(first).value_or(0))},
            {x(mapping_.longest_us()), y(mapping_.output_raw)},
            "stroke=\"#c00\" stroke-width=\"1\" stroke-dasharray=\"4 3\"");
  std::vector<SvgPoint> way;
  for (const std::int64_t pulse : mapping_.points_us()) {
    way.push_back({x(pulse), y(mapping_.limited_command(pulse).value_or(0))});
  }
  svg_.path(way, "stroke=\"#06c\" stroke-width=\"2.5\"");
}

void Drawing::points() {
  constexpr double steep = -60;
  for (const std::int64_t pulse : mapping_.points_us()) {
    svg_.dot({x(pulse), y(mapping_.limited_command(pulse).value_or(0))}, "fill=\"#06c\"");
    svg_.line({x(pulse), bottom}, {x(pulse), bottom + 5}, "stroke=\"#333\" stroke-width=\"1\"");
    svg_.label({x(pulse) + 4, bottom + 14}, "end", fmt::format("{} us", pulse), steep);
  }
}

std::string Drawing::text(std::string_view title) {
  svg_.label({left, top - 30}, "start", title);
  axes();
  curve();
  points();
  if (!mapping_.cut_off_us().empty()) {
    svg_.label({left, top - 14}, "start", say<texts::pwm_drawing_legend>());
  }
  return svg_.text();
}

} // namespace

std::string pwm_svg(const PwmMapping& mapping, std::string_view title) {
  return Drawing(mapping, title).text(title);
}

} // namespace blactl::cli
