#pragma once
// Draws on the whole terminal behind stdout, in place.

#include "blactl/base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// The look of a piece of a line; without colours by weight alone.
/// Blocks fill an area: their background is coloured.
enum class Look : std::uint8_t {
  plain,
  head,
  dim,
  good,
  warning,
  bad,
  chosen,
  lit,
  block,
  good_block,
  warning_block,
  bad_block,
  skip_block,
  in_block, ///< something has to come
  out_block ///< something has to go
};

struct Piece {
  std::string text{};
  Look look = Look::plain;
};

using ScreenLine = std::vector<Piece>;

/// A typed key: a character, or one of these, which are beyond Unicode.
using Key = char32_t;

namespace keys {
inline constexpr Key enter = U'\n', escape = 0x1B, end_of_input = 0x04;
inline constexpr Key up = 0x110000, down = 0x110001, left = 0x110002, right = 0x110003;
inline constexpr Key page_up = 0x110004, page_down = 0x110005, home = 0x110006, end = 0x110007;
inline constexpr Key back = 0x110008;
} // namespace keys

/// Uses ncurses, which supports all terminals, writes only changes, and is in every Debian
/// (notcurses requires a newer terminal than a Linux console; our own escape sequences would
/// support one kind of terminal). The terminal is restored when this ends, and while the process is
/// stopped (Ctrl-Z). Only one at a time.
class Screen {
 public:
  /// `colour`: whether colours may be used. Errors: unsupported, naming what the terminal lacks.
  [[nodiscard]] static Result<std::unique_ptr<Screen>> open(bool colour);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// In lines and columns.
  [[nodiscard]] std::size_t height() const;
  [[nodiscard]] std::size_t width() const;

  /// Adapts to the present size of the terminal.
  void fit();

  /// Draws from the first line on; lines that do not fit are cut.
  void draw(std::span<const ScreenLine> lines);

  /// Rings the bell of the terminal.
  static void ring();

  /// The next typed key; empty: none.
  [[nodiscard]] std::optional<Key> read();

  /// The descriptor to wait on for keys; -1: there is no input.
  [[nodiscard]] static int input();

 private:
  explicit Screen(bool colour);
};

} // namespace blactl::cli
