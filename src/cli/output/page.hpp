#pragma once
// The layout of texts for people: the columns of a terminal, and whether it shows colour.

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace blactl::cli {

/// The meaning of a word, shown by its colour.
enum class Tone : unsigned char { good, warning, bad };

struct Page {
  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

  std::size_t width = unlimited;  ///< in cells; unlimited for a pipe
  std::size_t height = unlimited; ///< in lines
  bool colour = false;
  bool unicode = true; ///< lines and dots for drawings; else ASCII

  [[nodiscard]] bool is_terminal() const { return width != unlimited; }

  /// `text` cut to the lines of the page less one; the last line then counts those left out.
  [[nodiscard]] std::string cut(std::string_view text) const;

  /// `text` in the colour of `tone`; unchanged without colours.
  [[nodiscard]] std::string paint(Tone tone, std::string_view text) const;

  /// Breaks lines of `text` longer than the page at words; continuation lines are indented a little
  /// more. Shorter lines are unchanged.
  [[nodiscard]] std::string fit(std::string_view text) const;

  /// Fits a hint: a command at its end is not broken, so that it can be copied.
  [[nodiscard]] std::string fit_hint(std::string_view hint) const;
};

/// The number of cells of a UTF-8 text on a terminal: two for Japanese characters, none for
/// colours.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// `text` with blanks before it, up to this number of cells.
[[nodiscard]] std::string right_aligned(const std::string& text, std::size_t width);

/// `text` in lines of at most `width` columns, all but the first indented by `indent`. Lines break
/// at spaces, and in Japanese at the end of words, as far as the characters show it. The first line
/// begins at `column`. A piece longer than a line is not cut.
[[nodiscard]] std::string wrap(std::string_view text, std::size_t width, std::size_t indent,
                               std::size_t column);

} // namespace blactl::cli
