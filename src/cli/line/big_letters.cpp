#include "cli/line/big_letters.hpp"

#include "cli/output/screen.hpp"

#include <map>
#include <string>
#include <utility>

namespace blactl::cli {

const Glyph& letter(char character) {
  static const std::map<char, Glyph> all{{'A', {".##.", "#..#", "####", "#..#", "#..#"}},
                                         {'B', {"###.", "#..#", "###.", "#..#", "###."}},
                                         {'D', {"###.", "#..#", "#..#", "#..#", "###."}},
                                         {'E', {"####", "#...", "###.", "#...", "####"}},
                                         {'F', {"####", "#...", "###.", "#...", "#..."}},
                                         {'G', {".###", "#...", "#.##", "#..#", ".###"}},
                                         {'N', {"#..#", "##.#", "#.##", "#..#", "#..#"}},
                                         {'I', {".###", "..#.", "..#.", "..#.", ".###"}},
                                         {'K', {"#..#", "#.#.", "##..", "#.#.", "#..#"}},
                                         {'L', {"#...", "#...", "#...", "#...", "####"}},
                                         {'O', {".##.", "#..#", "#..#", "#..#", ".##."}},
                                         {'P', {"###.", "#..#", "###.", "#...", "#..."}},
                                         {'R', {"###.", "#..#", "###.", "#.#.", "#..#"}},
                                         {'S', {".###", "#...", ".##.", "...#", "###."}},
                                         {'T', {".###", "..#.", "..#.", "..#.", "..#."}},
                                         {'U', {"#..#", "#..#", "#..#", "#..#", ".##."}},
                                         {'Y', {"#..#", "#..#", ".##.", ".#..", ".#.."}},
                                         {'0', {".##.", "#..#", "#..#", "#..#", ".##."}},
                                         {'1', {"..#.", ".##.", "..#.", "..#.", ".###"}},
                                         {'2', {"###.", "...#", ".##.", "#...", "####"}},
                                         {'3', {"###.", "...#", ".##.", "...#", "###."}},
                                         {'4', {"#..#", "#..#", "####", "...#", "...#"}},
                                         {'5', {"####", "#...", "###.", "...#", "###."}},
                                         {'6', {".##.", "#...", "###.", "#..#", ".##."}},
                                         {'7', {"####", "...#", "..#.", "..#.", "..#."}},
                                         {'8', {".##.", "#..#", ".##.", "#..#", ".##."}},
                                         {'9', {".##.", "#..#", ".###", "...#", ".##."}}};
  static const Glyph blank{"....", "....", "....", "....", "...."};
  const auto found = all.find(character);
  return found != all.end() ? found->second : blank;
}

void add_row(ScreenLine& line, std::string_view row, std::size_t square, Paint paint) {
  for (const char dot : row) {
    line.push_back({std::string(square, ' '), dot == '#' ? paint.ink : paint.ground});
  }
}

namespace {

/// One line of two rows of dots; `upper` may be empty.
void add_halves(ScreenLine& line, std::string_view upper, std::string_view lower, Paint paint) {
  const bool is_ground_lit = paint.ground != Look::plain;
  const Look lit = is_ground_lit ? paint.ground : paint.ink;
  const auto is_lit = [&](std::string_view row, std::size_t i) {
    return (i < row.size() && row[i] == '#') != is_ground_lit;
  };
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const bool is_upper = is_lit(upper, i), is_lower = is_lit(lower, i);
    line.push_back({is_upper == is_lower ? " "
                    : is_upper           ? "▄"
                                         : "▀",
                    is_upper || is_lower ? lit : Look::plain});
  }
}

} // namespace

void add_symbol(DrawnRow& row, const Glyph& symbol, Paint paint) {
  constexpr Glyph gap{".", ".", ".", ".", "."};
  for (const Glyph& each : {gap, symbol, gap}) {
    row.push_back({each, paint});
  }
}

void add_word(DrawnRow& row, std::string_view word, Paint paint) {
  for (const char each : word) {
    row.push_back({{".", ".", ".", ".", "."}, paint});
    row.push_back({letter(each), paint});
  }
}

std::size_t dots_of(const DrawnRow& row) {
  std::size_t dots = 0;
  for (const Drawn& each : row) {
    dots += each.glyph.front().size();
  }
  return dots;
}

std::vector<ScreenLine> lines_of(const DrawnRow& row, GlyphSize size, std::size_t width,
                                 Look ground) {
  const std::size_t dots = dots_of(row);
  if (dots > width) {
    return {};
  }
  const std::size_t square = size == GlyphSize::full && dots * 2 <= width ? 2 : 1;
  const std::size_t margin = (width - dots * square) / 2;
  std::vector<ScreenLine> lines;
  for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) {
    ScreenLine line{{std::string(margin, ' '), ground}};
    for (const Drawn& each : row) {
      size == GlyphSize::full ? add_row(line, each.glyph.at(i), square, each.paint)
                              : add_halves(line, i > 0 ? each.glyph.at(2 * i - 1) : "",
                                           each.glyph.at(2 * i), each.paint);
    }
    line.push_back({std::string(width - margin - dots * square, ' '), ground});
    lines.push_back(std::move(line));
  }
  return lines;
}

} // namespace blactl::cli
