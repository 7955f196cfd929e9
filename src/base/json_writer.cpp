#include "blactl/base/json_writer.hpp"

#include "blactl/base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace blactl {
namespace {

/// Characters that stand for themselves: ASCII without controls, quotation mark and backslash.
constexpr auto is_plain = [] {
  std::array<bool, 256> plain{};
  for (std::size_t c = 0x20; c < 0x7F; ++c) {
    plain[c] = c != '"' && c != '\\';
  }
  return plain;
}();

/// A character of the basic multilingual plane, which is all that is ever escaped so.
void append_escape(std::string& out, std::string_view character) {
  constexpr std::string_view digits = "0123456789abcdef";
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(character[i]); };
  const unsigned point = character.size() == 1   ? byte(0)
                         : character.size() == 2 ? (byte(0) & 0x1FU) << 6U | (byte(1) & 0x3FU)
                                                 : (byte(0) & 0x0FU) << 12U |
                                                       (byte(1) & 0x3FU) << 6U | (byte(2) & 0x3FU);
  out += "\\u";
  for (const unsigned shift : {12U, 8U, 4U, 0U}) {
    out += digits[point >> shift & 0xFU];
  }
}

/// The first character of `text`, which is not plain; returns its length.
std::size_t append_special(std::string& out, std::string_view text) {
  const std::size_t length = utf8_length(text);
  const std::string_view character = text.substr(0, length);
  if (length == 0) {
    out += "\uFFFD";
    return 1;
  }
  if (character == "\"" || character == "\\") {
    out += '\\';
    out += character;
  } else if (character == "\n") {
    out += "\\n";
  } else if (is_control(character)) {
    append_escape(out, character);
  } else {
    out += character;
  }
  return length;
}

} // namespace

void JsonWriter::break_line() {
  if (layout_ == Layout::pretty) {
    out_ += '\n';
    out_.append(static_cast<std::size_t>(depth_) * 2, ' ');
  }
}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (!first_) {
    out_ += ',';
  }
  first_ = false;
  if (depth_ > 0) {
    break_line();
  }
}

void JsonWriter::open(char bracket) {
  separate();
  out_ += bracket;
  ++depth_;
  first_ = true;
}

void JsonWriter::close(char bracket) {
  --depth_;
  if (!first_) {
    break_line();
  }
  out_ += bracket;
  first_ = false;
}

void JsonWriter::literal(std::string_view text) {
  separate();
  out_ += text;
}

void JsonWriter::real(double number) {
  if (!std::isfinite(number)) {
    literal("null");
    return;
  }
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  literal({digits.data(), end});
}

void JsonWriter::key(std::string_view name) {
  value(name);
  out_ += layout_ == Layout::pretty ? ": " : ":";
  after_key_ = true;
}

void JsonWriter::value(std::string_view text) {
  separate();
  out_ += '"';
  while (!text.empty()) {
    const auto plain = static_cast<std::size_t>(
        std::ranges::find_if_not(text,
                                 [](char c) { return is_plain[static_cast<std::uint8_t>(c)]; }) -
        text.begin());
    out_.append(text, 0, plain);
    text.remove_prefix(plain);
    if (!text.empty()) {
      text.remove_prefix(append_special(out_, text));
    }
  }
  out_ += '"';
}

} // namespace blactl
