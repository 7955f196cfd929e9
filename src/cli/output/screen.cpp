#include "cli/output/screen.hpp"

#include "cli/output/page.hpp"
#include "cli/texts.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#define NCURSES_NOMACROS
#include <curses.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace blactl::cli {
namespace {

constexpr short good_colour = 1, warning_colour = 2, bad_colour = 3, in_colour = 4, out_colour = 5,
                skip_colour = 6;

bool shows_colour = false;

attr_t colour_or(short pair, attr_t weight) {
  return shows_colour ? static_cast<attr_t>(COLOR_PAIR(pair)) : weight;
}

attr_t attributes(Look look) {
  switch (look) {
  case Look::plain: return A_NORMAL;
  case Look::head: return A_BOLD;
  case Look::dim: return A_DIM;
  case Look::chosen: return A_REVERSE;
  case Look::lit: return A_REVERSE | A_BOLD | colour_or(good_colour, A_NORMAL);
  case Look::good: return colour_or(good_colour, A_NORMAL);
  case Look::warning: return colour_or(warning_colour, A_BOLD);
  case Look::block: return A_REVERSE;
  case Look::good_block: return A_REVERSE | colour_or(good_colour, A_NORMAL);
  case Look::warning_block: return A_REVERSE | colour_or(warning_colour, A_NORMAL);
  case Look::bad_block: return A_REVERSE | colour_or(bad_colour, A_NORMAL);
  case Look::skip_block: return A_REVERSE | colour_or(skip_colour, A_NORMAL);
  case Look::in_block: return A_REVERSE | colour_or(in_colour, A_NORMAL);
  case Look::out_block: return A_REVERSE | colour_or(out_colour, A_NORMAL);
  case Look::bad: break;
  }
  return A_BOLD | colour_or(bad_colour, A_UNDERLINE);
}

void shorten(std::string_view& text) {
  const auto is_continued = [&text] {
    return (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U;
  };
  while (text.size() > 1 && is_continued()) {
    text.remove_suffix(1);
  }
  text.remove_suffix(1);
}

/// The beginning of a UTF-8 text, at most this number of cells wide.
std::string_view fitting(std::string_view text, std::size_t cells) {
  while (display_width(text) > cells) {
    shorten(text);
  }
  return text;
}

std::string_view terminal_name() {
  const char* name = std::getenv("TERM"); // NOLINT(concurrency-mt-unsafe): nobody sets it
  return name != nullptr ? name : "";
}

/// Wide characters need a UTF-8 locale. If the user's is not installed, the one in every Debian is
/// used.
void take_locale() {
  if (std::setlocale(LC_CTYPE, "") == nullptr || MB_CUR_MAX == 1) {
    (void)std::setlocale(LC_CTYPE, "C.UTF-8");
  }
}

std::optional<Key> special_key(int code) {
  switch (code) {
  case KEY_UP: return keys::up;
  case KEY_DOWN: return keys::down;
  case KEY_LEFT: return keys::left;
  case KEY_RIGHT: return keys::right;
  case KEY_PPAGE: return keys::page_up;
  case KEY_NPAGE: return keys::page_down;
  case KEY_HOME: return keys::home;
  case KEY_END: return keys::end;
  case KEY_BACKSPACE: return keys::back;
  case KEY_ENTER: return keys::enter;
  default: return std::nullopt;
  }
}

} // namespace

Result<std::unique_ptr<Screen>> Screen::open(bool colour) {
  const auto lacks = [](std::string message) {
    return std::unexpected(
        Error{Code::unsupported, std::move(message), say<texts::screen_hint>(), std::nullopt});
  };
  take_locale();
  if (newterm(nullptr, stdout, stdin) == nullptr) {
    return lacks(say<texts::screen_unknown>(terminal_name()));
  }
  if (const char* place = tigetstr("cup"); place == nullptr || *place == '\0') {
    endwin();
    return lacks(say<texts::screen_without_cursor>(terminal_name()));
  }
  return std::unique_ptr<Screen>(new Screen(colour));
}

Screen::Screen(bool colour) {
  constexpr int escape_wait_ms = 25; // for the rest of a key's sequence
  set_escdelay(escape_wait_ms);
  cbreak();
  noecho();
  curs_set(0);
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  shows_colour = colour && has_colors();
  if (shows_colour) {
    start_color();
    use_default_colors();
    init_pair(good_colour, COLOR_GREEN, -1);
    init_pair(warning_colour, COLOR_YELLOW, -1);
    init_pair(bad_colour, COLOR_RED, -1);
    init_pair(in_colour, COLOR_CYAN, -1);
    init_pair(out_colour, COLOR_MAGENTA, -1);
    constexpr short bright_blue = 12; // of 16: the other one is dark on black
    init_pair(skip_colour, COLORS > bright_blue ? bright_blue : COLOR_BLUE, -1);
  }
}

Screen::~Screen() {
  endwin();
}

std::size_t Screen::height() const {
  return static_cast<std::size_t>(getmaxy(stdscr));
}

std::size_t Screen::width() const {
  return static_cast<std::size_t>(getmaxx(stdscr));
}

void Screen::fit() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0 &&
      is_term_resized(size.ws_row, size.ws_col)) {
    resizeterm(size.ws_row, size.ws_col);
  }
}

void Screen::draw(std::span<const ScreenLine> lines) {
  werase(stdscr);
  for (std::size_t row = 0; row < lines.size() && row < height(); ++row) {
    wmove(stdscr, static_cast<int>(row), 0);
    std::size_t left = width();
    for (const Piece& piece : lines[row]) {
      const std::string_view text = fitting(piece.text, left);
      left -= display_width(text);
      wattrset(stdscr, static_cast<int>(attributes(piece.look)));
      waddnstr(stdscr, text.data(), static_cast<int>(text.size()));
    }
  }
  wattrset(stdscr, A_NORMAL);
  wrefresh(stdscr);
}

void Screen::ring() {
  beep();
}

std::optional<Key> Screen::read() {
  for (int code = wgetch(stdscr); code != ERR; code = wgetch(stdscr)) {
    if (const auto special = special_key(code)) {
      return special;
    }
    constexpr int delete_key = 0x7F; // sent by Backspace in most terminals
    if (code == '\r') {
      return keys::enter;
    }
    if (code == delete_key || code == '\b') {
      return keys::back;
    }
    if (code < delete_key) {
      return static_cast<Key>(code);
    }
  }
  return std::nullopt;
}

int Screen::input() {
  return isatty(STDIN_FILENO) != 0 ? STDIN_FILENO : -1;
}

} // namespace blactl::cli
