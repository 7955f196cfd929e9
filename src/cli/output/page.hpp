#pragma once
// What a text for people is laid out for: the columns of a terminal, and whether it shows colour.

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace blactl::cli {

/// What a word tells at a glance.
enum class Tone : unsigned char { good, warning, bad };

struct Page {
  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

  std::size_t width = unlimited;  ///< in cells; a pipe has no end of line
  std::size_t height = unlimited; ///< in lines
  bool colour = false;
  bool unicode = true; ///< lines and dots for drawings; else ASCII

  [[nodiscard]] bool is_terminal() const { return width != unlimited; }

  /// `text` as far as its lines fit on the page with one to spare; the last one tells how many do
  /// not.
  [[nodiscard]] std::string cut(std::string_view text) const;

  /// `text` in the colour of `tone`; as it is where no colour is shown.
  [[nodiscard]] std::string paint(Tone tone, std::string_view text) const;

  /// Breaks each line of `text` that is longer than the page, at words; what follows is indented a
  /// little more than the line. Shorter lines stay as they are.
  [[nodiscard]] std::string fit(std::string_view text) const;

  /// The same for a hint: the command that it ends with is not broken, so that it can be copied.
  [[nodiscard]] std::string fit_hint(std::string_view hint) const;
};

/// How many cells of a terminal a UTF-8 text takes: Japanese characters two, colours none.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// `text` in lines of at most `width` columns, all but the first indented by `indent`. Lines break
/// at spaces, and in Japanese where a word has ended as far as its characters tell. `column` is
/// where the first line begins. What does not fit into a whole line stands out rather than being
/// cut.
[[nodiscard]] std::string wrap(std::string_view text, std::size_t width, std::size_t indent,
                               std::size_t column);

} // namespace blactl::cli
