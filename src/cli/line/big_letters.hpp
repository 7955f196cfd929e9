#pragma once
// Letters, digits and symbols that are read from two metres: five squares high, drawn in colours.

#include "cli/output/screen.hpp"

#include <array>
#include <cstddef>
#include <string_view>

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

/// A capital of the words of this room, a digit, or else a blank: four squares wide.
[[nodiscard]] const Glyph& letter(char character);

/// The colours of an area and of what is drawn on it.
struct Paint {
  Look ground, ink;
};

/// One row of a glyph: squares of `square` cells.
void add_row(ScreenLine& line, std::string_view row, std::size_t square, Paint paint);

} // namespace blactl::cli
