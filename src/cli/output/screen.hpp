#pragma once
// The whole terminal behind stdout, drawn again and again in place.

#include "blactl/base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// How a piece of a line stands out; on a terminal without colours by weight alone.
enum class Look : std::uint8_t { plain, head, dim, good, warning, bad, chosen, lit };

struct Piece {
  std::string text{};
  Look look = Look::plain;
};

using ScreenLine = std::vector<Piece>;

/// What was typed: a character, or one of these, which lie beyond Unicode.
using Key = char32_t;

namespace keys {
inline constexpr Key enter = U'\n', escape = 0x1B;
inline constexpr Key up = 0x110000, down = 0x110001, left = 0x110002, right = 0x110003;
inline constexpr Key page_up = 0x110004, page_down = 0x110005, home = 0x110006, end = 0x110007;
inline constexpr Key back = 0x110008;
} // namespace keys

/// Drawn by ncurses, which knows the terminals, writes only what has changed, and is in every
/// Debian (notcurses wants a newer terminal than a Linux console is; escape sequences of our own
/// would know one kind of terminal). The terminal is as it was when this ends, and while the
/// process is stopped (Ctrl-Z). One at a time.
class Screen {
 public:
  /// `colour`: whether colours may be used. Errors: unsupported, with what the terminal lacks.
  [[nodiscard]] static Result<std::unique_ptr<Screen>> open(bool colour);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// In lines and columns.
  [[nodiscard]] std::size_t height() const;
  [[nodiscard]] std::size_t width() const;

  /// Takes the size that the terminal has now.
  void fit();

  /// From the first line on; what does not fit is cut.
  void draw(std::span<const ScreenLine> lines);

  /// The next key that was typed; empty: none.
  [[nodiscard]] std::optional<Key> read();

  /// What to wait for until a key can be read; -1: nobody can type.
  [[nodiscard]] static int input();

 private:
  explicit Screen(bool colour);
};

} // namespace blactl::cli
