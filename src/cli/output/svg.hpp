#pragma once
// A drawing for browsers, built shape by shape.

#include <span>
#include <string>
#include <string_view>

namespace blactl::cli {

/// A point of the drawing, from its upper left corner, in points.
struct SvgPoint {
  double x = 0, y = 0;
};

/// `look` holds SVG's presentation attributes: "stroke=\"#999\" stroke-width=\"0.7\"". Texts are
/// untrusted.
class Svg {
 public:
  /// A white page; the title is for programs and not visible.
  Svg(double width, double height, std::string_view title);

  void line(SvgPoint from, SvgPoint to, std::string_view look);

  /// Draws a path without filling.
  void path(std::span<const SvgPoint> points, std::string_view look);

  void dot(SvgPoint at, std::string_view look);

  /// `anchor`: the end of the text at the point: "start", "middle", "end". `degrees`: clockwise
  /// rotation around it.
  void label(SvgPoint at, std::string_view anchor, std::string_view text, double degrees = 0);

  /// The file; drawing ends with it.
  [[nodiscard]] std::string text();

 private:
  std::string out_;
};

} // namespace blactl::cli
