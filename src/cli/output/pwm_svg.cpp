#include "blactl/base/text.hpp"

#include "cli/output/pwm_view.hpp"
#include "cli/pwm_texts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace blactl::cli {
namespace {

using bla::PwmMapping;

/// Of the drawing: an A5 page in landscape, in points.
constexpr double width = 595, height = 420;
constexpr double left = 80, right = 560, top = 60, bottom = 350;

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : printable(text)) {
    switch (c) {
    case '<': out += "&lt;"; break;
    case '>': out += "&gt;"; break;
    case '&': out += "&amp;"; break;
    case '"': out += "&quot;"; break;
    default: out += c;
    }
  }
  return out;
}

class Drawing {
 public:
  explicit Drawing(const PwmMapping& mapping) : mapping_(mapping) {}

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

  void line(double x1, double y1, double x2, double y2, std::string_view look) {
    out_ += fmt::format("  <line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                        x1, y1, x2, y2, look);
  }

  void label(double at_x, double at_y, std::string_view anchor, std::string_view text) {
    out_ += fmt::format("  <text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", at_x,
                        at_y, anchor, escaped(text));
  }

  void curve();
  void axes();
  void points();

  const PwmMapping& mapping_;
  std::string out_;
};

void Drawing::axes() {
  constexpr std::string_view thin = "stroke=\"#999\" stroke-width=\"0.7\"";
  line(left, y(0), right, y(0), thin);
  line(x(mapping_.neutral_us), top, x(mapping_.neutral_us), bottom, thin);
  for (const std::int64_t command : {mapping_.output_raw, std::int64_t{0}, -mapping_.output_raw}) {
    label(left - 8, y(command) + 4, "end", pwm_command_text(mapping_, command));
  }
}

/// What the servo is told, and thicker what the limits leave of it.
void Drawing::curve() {
  const std::int64_t first = mapping_.points_us().front();
  line(x(first), y(mapping_.command(first).value_or(0)), x(mapping_.longest_us()),
       y(mapping_.output_raw), "stroke=\"#c00\" stroke-width=\"1\" stroke-dasharray=\"4 3\"");
  std::string path;
  for (const std::int64_t pulse : mapping_.points_us()) {
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x(pulse),
                        y(mapping_.limited_command(pulse).value_or(0)));
  }
  out_ +=
      fmt::format("  <path d=\"{}\" fill=\"none\" stroke=\"#06c\" stroke-width=\"2.5\"/>\n", path);
}

void Drawing::points() {
  for (const std::int64_t pulse : mapping_.points_us()) {
    const std::int64_t command = mapping_.limited_command(pulse).value_or(0);
    out_ += fmt::format("  <circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"#06c\"/>\n",
                        x(pulse), y(command));
    line(x(pulse), bottom, x(pulse), bottom + 5, "stroke=\"#333\" stroke-width=\"1\"");
    out_ += fmt::format("  <text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"end\" "
                        "transform=\"rotate(-60 {0:.1f} {1:.1f})\">{2} us</text>\n",
                        x(pulse) + 4, bottom + 14, pulse);
  }
}

std::string Drawing::text(std::string_view title) {
  out_ = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
                     "width=\"{0:.0f}pt\" height=\"{1:.0f}pt\" font-family=\"sans-serif\" "
                     "font-size=\"11\">\n"
                     "  <title>{2}</title>\n"
                     "  <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
                     width, height, escaped(title));
  label(left, top - 30, "start", title);
  axes();
  curve();
  points();
  if (!mapping_.cut_off_us().empty()) {
    label(left, top - 14, "start", say<texts::pwm_drawing_legend>());
  }
  return std::move(out_) + "</svg>\n";
}

} // namespace

std::string pwm_svg(const PwmMapping& mapping, std::string_view title) {
  return Drawing(mapping).text(title);
}

} // namespace blactl::cli
