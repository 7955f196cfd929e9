#pragma once
// A drawing that a browser shows and prints, built shape by shape.

#include <span>
#include <string>
#include <string_view>

namespace blactl::cli {

/// Of the drawing, from its upper left corner, in points.
struct SvgPoint {
  double x = 0, y = 0;
};

/// `look` is what SVG calls presentation attributes: "stroke=\"#999\" stroke-width=\"0.7\"". Texts
/// are foreign.
class Svg {
 public:
  /// White, with the title for programs; people see it only once it is a label.
  Svg(double width, double height, std::string_view title);

  void line(SvgPoint from, SvgPoint to, std::string_view look);

  /// Not filled.
  void path(std::span<const SvgPoint> points, std::string_view look);

  void dot(SvgPoint at, std::string_view look);

  /// `anchor`: which end of the text is there: "start", "middle", "end". `degrees`: turned
  /// clockwise around that.
  void label(SvgPoint at, std::string_view anchor, std::string_view text, double degrees = 0);

  /// The file; nothing can be drawn after it.
  [[nodiscard]] std::string text();

 private:
  std::string out_;
};

} // namespace blactl::cli
