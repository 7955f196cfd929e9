#pragma once
// The words and numbers that lines of logs are made of. Nothing here allocates.

#include "blactl/base/letter_case.hpp"
#include "blactl/base/time.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace blactl::can {

/// A time with more digits before the point is none that anybody logged, and would overflow.
inline constexpr std::size_t most_time_digits = 11;

inline constexpr auto digit_values = [] {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < 10; ++i) {
    values['0' + i] = static_cast<std::int8_t>(i);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    values['A' + i] = values['a' + i] = static_cast<std::int8_t>(10 + i);
  }
  return values;
}();

/// Negative: not a digit.
constexpr int hex_digit(char c) {
  return digit_values[static_cast<std::uint8_t>(c)];
}

constexpr bool is_decimal(char c) {
  return c >= '0' && c <= '9';
}

constexpr bool are_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, is_decimal);
}

/// The number, if all of `text`, of eight characters at most, is digits. That of "" is 0.
constexpr std::optional<std::uint32_t> hex_number(std::string_view text) {
  std::uint32_t value = 0;
  int bad = 0;
  for (const char c : text) {
    const int digit = hex_digit(c);
    bad |= digit;
    value = value << 4U | static_cast<std::uint32_t>(digit & 0xF);
  }
  return bad < 0 ? std::nullopt : std::optional(value);
}

/// The number of one to eight hexadecimal digits.
constexpr std::optional<std::uint32_t> hex_word(std::string_view text) {
  constexpr std::size_t most_digits = 8;
  return !text.empty() && text.size() <= most_digits ? hex_number(text) : std::nullopt;
}

/// A byte of two hexadecimal digits.
constexpr std::optional<std::uint32_t> hex_byte(std::string_view text) {
  return text.size() == 2 ? hex_number(text) : std::nullopt;
}

/// The number of these digits, 18 at most.
constexpr std::int64_t decimal(std::string_view digits) {
  std::int64_t value = 0;
  for (const char c : digits) {
    value = value * 10 + (c - '0');
  }
  return value;
}

/// The number, if all of `text` is digits and it is not above `most`.
constexpr std::optional<std::uint32_t> whole_number(std::string_view text, std::uint32_t most) {
  constexpr std::size_t most_digits = 10;
  if (!are_digits(text) || text.size() > most_digits || decimal(text) > most) {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(decimal(text));
}

/// The digits behind a point as a number with `places` places, 18 at most; further ones are cut.
constexpr std::int64_t scaled(std::string_view fraction, std::size_t places) {
  const auto digits = fraction.substr(0, places);
  std::int64_t value = decimal(digits);
  for (std::size_t i = digits.size(); i < places; ++i) {
    value *= 10;
  }
  return value;
}

/// "1059.9": what stands before the point, and the digits behind it.
struct DecimalFraction {
  std::int64_t whole = 0;
  std::string_view fraction{};

  [[nodiscard]] static constexpr std::optional<DecimalFraction> parse(std::string_view text) {
    const auto point = std::min(text.find('.'), text.size());
    const auto whole = text.substr(0, point);
    const auto fraction = text.substr(std::min(point + 1, text.size()));
    if (!are_digits(whole) || !are_digits(fraction) || whole.size() > most_time_digits) {
      return std::nullopt;
    }
    return DecimalFraction{decimal(whole), fraction};
  }
};

/// The words of a line, which spaces and tabs separate.
class Words {
 public:
  explicit constexpr Words(std::string_view rest) : rest_(rest) {}

  /// Empty: there are no more.
  constexpr std::string_view next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
    const auto word = rest_.substr(0, rest_.find_first_of(blanks));
    rest_.remove_prefix(word.size());
    return word;
  }

 private:
  static constexpr std::string_view blanks = " \t";
  std::string_view rest_;
};

/// The line without its end.
constexpr std::string_view without_line_end(std::string_view line) {
  while (line.ends_with('\n') || line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

/// The highest number of a channel.
inline constexpr std::uint32_t most_channel = 255;

/// A channel's name as that of an interface: "can1".
class ChannelName {
 public:
  /// `channel`: up to most_channel.
  std::string_view set(std::uint32_t channel) {
    char* const digits = text_.data() + prefix;
    const char* const end = std::to_chars(digits, text_.data() + text_.size(), channel).ptr;
    return {text_.data(), end};
  }

  /// Where the log does not number its channels.
  [[nodiscard]] std::string_view unnumbered() const { return {text_.data(), prefix}; }

 private:
  static constexpr std::size_t prefix = 3;
  std::array<char, prefix + 3> text_{'c', 'a', 'n'};
};

} // namespace blactl::can
