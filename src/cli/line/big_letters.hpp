#pragma once
// Letters, digits and symbols that are read from two metres: five dots high, drawn in colours.

#include "cli/output/screen.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace blactl::cli {

inline constexpr std::size_t glyph_height = 5;

using Glyph = std::array<std::string_view, glyph_height>;

inline constexpr Glyph arrow_down{"..#..", "..#..", "#.#.#", ".###.", "..#.."};
inline constexpr Glyph arrow_up{"..#..", ".###.", "#.#.#", "..#..", "..#.."};
inline constexpr Glyph arrows_up{"..#..", ".###.", "#.#.#", ".###.", "#.#.#"};
inline constexpr Glyph arrow_aside{"..#..", "...#.", "#####", "...#.", "..#.."};
inline constexpr Glyph bars{"#.#.#", "#.#.#", "#.#.#", "#.#.#", "#.#.#"};
inline constexpr Glyph barrier{"#####", "#####", "#####", "#####", "#####"};
inline constexpr Glyph ring{".###.", "#...#", "#...#", "#...#", ".###."};
inline constexpr Glyph cross{"#...#", ".#.#.", "..#..", ".#.#.", "#...#"};
inline constexpr Glyph exclamation{"..#..", "..#..", "..#..", ".....", "..#.."};
inline constexpr Glyph equal{".....", "#####", ".....", "#####", "....."};
inline constexpr Glyph unequal{"...#.", "#####", "..#..", "#####", ".#..."};

/// A capital of the words of this room, a digit, or else a blank: four squares wide.
[[nodiscard]] const Glyph& letter(char character);

/// The colours of an area and of what is drawn on it; one of them is plain.
struct Paint {
  Look ground, ink;
};

/// A glyph with a gap on both sides if it is a symbol.
struct Drawn {
  Glyph glyph;
  Paint paint;
};

/// Symbols and letters beside each other.
using DrawnRow = std::vector<Drawn>;

void add_symbol(DrawnRow& row, const Glyph& symbol, Paint paint);
void add_word(DrawnRow& row, std::string_view word, Paint paint);

/// The dots of a row from end to end.
[[nodiscard]] std::size_t dots_of(const DrawnRow& row);

/// Lines of a terminal that a row takes.
enum class GlyphSize : std::uint8_t {
  half = 3, ///< two dots in a cell, one above the other; a gap of half a line above
  full = 5  ///< a dot is a line high, and two cells wide where the width suffices
};

/// The row in the middle of lines of this width, on this ground; empty: it is wider.
[[nodiscard]] std::vector<ScreenLine> lines_of(const DrawnRow& row, GlyphSize size,
                                               std::size_t width, Look ground);

/// One row of a glyph: squares of `square` cells.
void add_row(ScreenLine& line, std::string_view row, std::size_t square, Paint paint);

} // namespace blactl::cli
