#include "blactl/base/text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace blactl {
namespace {

Language current = Language::english;

} // namespace

void set_language(Language language) {
  current = language;
}

Language language() {
  return current;
}

std::string_view choose(std::string_view en, std::string_view ja) {
  return current == Language::japanese && !ja.empty() ? ja : en;
}

std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) {
    return 1;
  }
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) {
      return 0;
    }
  }
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool beyond = (first == 0xED && byte(1) > 0x9F) || (first == 0xF4 && byte(1) > 0x8F);
  return overlong || beyond ? 0 : length;
}

bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(character[i]); };
  if (character.size() == 1) {
    return byte(0) < 0x20 || byte(0) == 0x7F;
  }
  if (character.size() == 2) { // U+0080..9F
    return byte(0) == 0xC2 && byte(1) < 0xA0;
  }
  if (character.size() == 3 && byte(0) == 0xE2) { // U+200B..F, U+2028..E, U+2066..9
    return (byte(1) == 0x80 &&
            ((byte(2) >= 0x8B && byte(2) <= 0x8F) || (byte(2) >= 0xA8 && byte(2) <= 0xAE))) ||
           (byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9);
  }
  return character == "\xEF\xBB\xBF"; // U+FEFF
}

std::string printable(std::string_view foreign) {
  constexpr std::array digits{'0', '1', '2', '3', '4', '5', '6', '7',
                              '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  std::string out;
  out.reserve(foreign.size());
  while (!foreign.empty()) {
    const std::size_t length = utf8_length(foreign);
    const std::string_view character = foreign.substr(0, length == 0 ? 1 : length);
    if (length == 0 || is_control(character)) {
      for (const char c : character) {
        const auto byte = static_cast<std::uint8_t>(c);
        out += {'\\', 'x', digits[byte >> 4], digits[byte & 0xF]};
      }
    } else {
      out += character;
    }
    foreign.remove_prefix(character.size());
  }
  return out;
}

std::string shell_word(std::string_view foreign) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                     "0123456789._/:=+,@%-";
  std::string text = printable(foreign);
  const bool is_plain = std::ranges::all_of(
      text, [&](char c) { return plain.contains(c) || static_cast<std::uint8_t>(c) >= 0x80; });
  if (is_plain && !text.empty()) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string_view("'\\''") : std::string_view(&c, 1);
  }
  return quoted + "'";
}

} // namespace blactl
