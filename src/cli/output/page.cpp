#include "cli/output/page.hpp"

#include "blactl/base/text.hpp"

#include "cli/texts.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace blactl::cli {
namespace {

/// One code point of well-formed UTF-8, removed from the front of `text`.
char32_t take_code_point(std::string_view& text) {
  const auto first = static_cast<std::uint8_t>(text.front());
  const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  char32_t point = length == 1 ? first : first & (0x7FU >> length);
  for (std::size_t i = 1; i < length && i < text.size(); ++i) {
    point = point << 6 | (static_cast<std::uint8_t>(text[i]) & 0x3FU);
  }
  text.remove_prefix(std::min(length, text.size()));
  return point;
}

/// Whether it is an East Asian wide or full-width character (Unicode Standard Annex 11), as far as
/// they occur in names of parameters, hints and foreign nodes.
bool is_wide(char32_t point) {
  struct Range {
    char32_t first, last;
  };

  constexpr Range wide[] = {
      {0x1100, 0x115F}, {0x2E80, 0x303E},   {0x3041, 0x33FF},   {0x3400, 0x4DBF}, {0x4E00, 0x9FFF},
      {0xA000, 0xA4CF}, {0xAC00, 0xD7A3},   {0xF900, 0xFAFF},   {0xFE30, 0xFE4F}, {0xFF00, 0xFF60},
      {0xFFE0, 0xFFE6}, {0x1F300, 0x1FAFF}, {0x20000, 0x3FFFD},
  };
  return std::ranges::any_of(
      wide, [&](const Range& range) { return point >= range.first && point <= range.last; });
}

/// The length of the colour sequence at the start of `text` (ECMA-48, SGR); 0: none.
std::size_t colour_length(std::string_view text) {
  return text.starts_with("\x1b[") ? std::min(text.find('m'), text.size() - 1) + 1 : 0;
}

/// A piece of text that is not broken.
struct Unit {
  std::string text;
  bool spaced = false; ///< preceded by a space
};

/// In the order of Unicode, which UTF-8 keeps.
bool is_hiragana(std::string_view character) {
  return character >= "ぁ" && character <= "ゟ";
}

bool is_one_of(std::span<const std::string_view> characters, std::string_view character) {
  return std::ranges::find(characters, character) != characters.end();
}

/// Whether a Japanese line may break: after punctuation, and after the hiragana that end most
/// words. Brackets stay with their content.
bool may_break(std::string_view before, std::string_view after) {
  constexpr std::string_view closing[]{"、", "。", "」", "）", "：", "～", "…", ")", ",", ".", ":"};
  constexpr std::string_view pauses[]{"、", "。"};
  if (is_one_of(closing, after)) {
    return false;
  }
  return is_one_of(pauses, before) || (is_hiragana(before) && !is_hiragana(after));
}

/// "0x38", with an opening bracket before it: the name that follows stays with it.
bool is_address(std::string_view unit) {
  unit.remove_prefix(unit.starts_with('(') ? 1 : 0);
  return unit.size() == 4 && unit.starts_with("0x");
}

/// The first piece of `text`: a command in backquotes that is no longer than a line, else one
/// character.
std::string_view first_piece(std::string_view text, std::size_t longest) {
  const std::size_t end = text.starts_with('`') ? text.find('`', 1) : std::string_view::npos;
  if (end != std::string_view::npos && display_width(text.substr(0, end + 1)) <= longest) {
    return text.substr(0, end + 1);
  }
  return text.substr(0, std::max<std::size_t>(utf8_length(text), 1));
}

/// `longest`: the longest piece that fits on a line.
std::vector<Unit> units_of(std::string_view text, std::size_t longest) {
  std::vector<Unit> units;
  std::string_view before = " ";
  while (!text.empty()) {
    const std::string_view character = first_piece(text, longest);
    text.remove_prefix(character.size());
    const bool is_name = !text.empty() && text.front() >= 'a' && text.front() <= 'z';
    if (character == " " && is_name && !units.empty() && is_address(units.back().text)) {
      units.back().text += character;
      continue;
    }
    if (character != " ") {
      if (before == " " || may_break(before, character)) {
        units.push_back({{}, before == " " && !units.empty()});
      }
      units.back().text += character;
    }
    before = character;
  }
  return units;
}

std::string spaces(std::size_t count) {
  return std::string(count, ' ');
}

std::string_view code_of(Tone tone) {
  switch (tone) {
  case Tone::good: return "\x1b[32m";
  case Tone::warning: return "\x1b[33m";
  case Tone::bad: return "\x1b[1;31m";
  }
  return {};
}

} // namespace

std::string right_aligned(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, display_width(text)), ' ') + text;
}

std::size_t display_width(std::string_view text) {
  std::size_t width = 0;
  while (!text.empty()) {
    if (const std::size_t colour = colour_length(text); colour > 0) {
      text.remove_prefix(colour);
    } else {
      width += is_wide(take_code_point(text)) ? 2U : 1U;
    }
  }
  return width;
}

std::string wrap(std::string_view text, std::size_t width, std::size_t indent, std::size_t column) {
  std::string out;
  bool line_is_empty = true;
  for (const Unit& unit : units_of(text, width > indent ? width - indent : 0)) {
    const std::size_t gap = unit.spaced && !line_is_empty ? 1 : 0;
    const std::size_t needed = gap + display_width(unit.text);
    if (!line_is_empty && column + needed > width) {
      out += "\n" + spaces(indent);
      column = indent;
      out += unit.text;
      column += display_width(unit.text);
      continue;
    }
    out += spaces(gap) + unit.text;
    column += needed;
    line_is_empty = false;
  }
  return out;
}

std::string Page::cut(std::string_view text) const {
  const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n'));
  if (height == unlimited || lines < height) {
    return std::string(text);
  }
  const std::size_t kept = height - 2;
  std::size_t end = 0;
  for (std::size_t line = 0; line < kept; ++line) {
    end = text.find('\n', end) + 1;
  }
  return std::string(text.substr(0, end)) + say<texts::more_lines>(lines - kept) + '\n';
}

std::string Page::paint(Tone tone, std::string_view text) const {
  std::string painted(text);
  return colour && !text.empty() ? painted.insert(0, code_of(tone)) + "\x1b[0m" : painted;
}

std::string Page::fit(std::string_view text) const {
  constexpr std::size_t deeper = 4;
  std::string out;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    const std::size_t margin = std::min(line.find_first_not_of(' '), line.size());
    out += display_width(line) <= width
               ? std::string(line)
               : spaces(margin) + wrap(line, width, margin + deeper, margin);
    if (end == std::string_view::npos) {
      break;
    }
    out += '\n';
    text.remove_prefix(end + 1);
  }
  return out;
}

std::string Page::fit_hint(std::string_view hint) const {
  std::size_t command = std::string_view::npos;
  for (const std::string_view beginning : {": blactl ", ": sudo ", ": --"}) {
    command = command == std::string_view::npos ? hint.rfind(beginning) : command;
  }
  if (display_width(hint) <= width || command == std::string_view::npos) {
    return fit(hint);
  }
  const std::size_t end = command + 1;
  return fit(hint.substr(0, end)) + "\n      " + std::string(hint.substr(end + 1));
}

} // namespace blactl::cli
