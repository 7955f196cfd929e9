#include "cli/output/svg.hpp"

#include "blactl/base/text.hpp"

#include <fmt/format.h>

#include <utility>

namespace blactl::cli {
namespace {

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

} // namespace

Svg::Svg(double width, double height, std::string_view title)
    : out_(fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
                       "width=\"{0:.0f}pt\" height=\"{1:.0f}pt\" font-family=\"sans-serif\" "
                       "font-size=\"11\">\n"
                       "  <title>{2}</title>\n"
                       "  <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
                       width, height, escaped(title))) {}

void Svg::line(SvgPoint from, SvgPoint to, std::string_view look) {
  out_ += fmt::format("  <line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                      from.x, from.y, to.x, to.y, look);
}

void Svg::path(std::span<const SvgPoint> points, std::string_view look) {
  std::string way;
  for (const SvgPoint& point : points) {
    way += fmt::format("{}{:.1f} {:.1f}", way.empty() ? "M" : " L", point.x, point.y);
  }
  out_ += fmt::format("  <path d=\"{}\" fill=\"none\" {}/>\n", way, look);
}

void Svg::dot(SvgPoint at, std::string_view look) {
  out_ += fmt::format("  <circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" {}/>\n", at.x, at.y, look);
}

void Svg::label(SvgPoint at, std::string_view anchor, std::string_view text, double degrees) {
  const std::string turned =
      degrees == 0
          ? std::string()
          : fmt::format(" transform=\"rotate({:.0f} {:.1f} {:.1f})\"", degrees, at.x, at.y);
  out_ += fmt::format("  <text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", at.x,
                      at.y, anchor, turned, escaped(text));
}

std::string Svg::text() {
  return std::move(out_) + "</svg>\n";
}

} // namespace blactl::cli
