#include "blactl/can/candump.hpp"

#include "can/log/log_words.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::can {
namespace {

/// Set in the ID of an error frame (CAN_ERR_FLAG of linux/can.h).
constexpr std::uint32_t error_flag = 0x2000'0000;
constexpr std::size_t standard_digits = 3;
constexpr std::size_t extended_digits = 8;

/// candump writes absolute stamps as %010lu.%06lu, the others as %03lu.%06lu.
constexpr std::size_t absolute_digits = 10;
constexpr std::size_t micro_digits = 6;

/// Takes words and characters off the front of a line.
class Scanner {
 public:
  explicit Scanner(std::string_view rest) : rest_(rest) {}

  [[nodiscard]] std::string_view rest() const { return rest_; }

  void skip_spaces() { rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size())); }

  bool skip(char c) {
    const bool found = rest_.starts_with(c);
    rest_.remove_prefix(found ? 1 : 0);
    return found;
  }

  /// The text up to the next space.
  std::string_view word() {
    skip_spaces();
    const auto word = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(word.size());
    return word;
  }

  std::string_view digits() {
    std::size_t size = 0;
    while (size < rest_.size() && is_decimal(rest_[size])) {
      ++size;
    }
    const auto digits = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return digits;
  }

 private:
  std::string_view rest_;
};

/// ".249713)" or ".249713456)", cut to microseconds.
std::optional<Duration> fraction(Scanner& in) {
  const bool point = in.skip('.');
  const auto digits = in.digits();
  if (!point || digits.empty() || !in.skip(')')) {
    return std::nullopt;
  }
  return Duration(scaled(digits, micro_digits));
}

/// "-07-10 06:50:52" behind the year.
std::optional<WallTime> date(std::int64_t year, Scanner& in) {
  std::array<unsigned, 5> fields{};
  constexpr std::string_view separators = "-- ::";
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const bool separated = in.skip(separators[i]);
    const auto digits = in.digits();
    if (!separated || digits.size() != 2) {
      return std::nullopt;
    }
    fields[i] = static_cast<unsigned>(decimal(digits));
  }
  const auto [month, day, hour, minute, second] = fields;
  const std::chrono::year_month_day days(std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(month), std::chrono::day(day));
  if (!days.ok() || hour > 23 || minute > 59 || second > 60) {
    return std::nullopt;
  }
  return std::chrono::sys_days(days) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
         std::chrono::seconds(second);
}

/// Reads the time stamp after the opening parenthesis.
bool take_stamp(Scanner& in, LogLine& line) {
  const auto digits = in.digits();
  if (digits.empty() || digits.size() > most_time_digits) {
    return false;
  }
  line.stamp = LogLine::Stamp::absolute;
  if (digits.size() == 4 && in.rest().starts_with('-')) {
    const auto seconds = date(decimal(digits), in);
    if (!seconds) {
      return false;
    }
    line.at = *seconds;
  } else {
    line.at = WallTime(std::chrono::seconds(decimal(digits)));
    if (digits.size() < absolute_digits) {
      line.stamp = LogLine::Stamp::relative;
    }
  }
  const auto rest = fraction(in);
  line.at += rest.value_or(Duration());
  return rest.has_value();
}

/// "123", "1401552A", "20000080": standard, extended, error frame.
bool take_id(std::string_view text, LogLine& line) {
  const auto id = hex_number(text);
  if (!id) {
    return false;
  }
  line.kind = LogLine::Kind::frame;
  line.frame.id = *id;
  line.frame.extended = text.size() == extended_digits;
  if (text.size() == standard_digits) {
    return *id <= standard_id_mask;
  }
  if ((*id & error_flag) != 0) {
    line.kind = LogLine::Kind::error;
    line.frame.id = *id & ~error_flag;
  }
  return line.frame.extended && line.frame.id <= extended_id_mask;
}

/// Data of the log format: hexadecimal digits, which tools may separate by dots; after eight bytes
/// the length code from the wire ("_E") may follow.
bool take_data(std::string_view text, Frame& frame) {
  std::size_t size = 0;
  std::size_t at = 0;
  while (at + 1 < text.size() && size < frame.data.size()) {
    const int value = hex_digit(text[at]) << 4 | hex_digit(text[at + 1]);
    if (value < 0) {
      break;
    }
    frame.data[size++] = static_cast<std::uint8_t>(value);
    at += 2;
    at += at + 1 < text.size() && text[at] == '.' ? 1U : 0U;
  }
  frame.size = static_cast<std::uint8_t>(size);
  const auto rest = text.substr(at);
  return rest.empty() || (size == frame.data.size() && rest.size() == 2 && rest[0] == '_' &&
                          hex_digit(rest[1]) > 8);
}

/// "R", "R5", "R8_E": a remote frame with its length code.
bool take_remote(std::string_view text, Frame& frame) {
  frame.remote = true;
  if (text.size() > 1) {
    const int size = hex_digit(text[1]);
    if (size < 0 || size > 8) {
      return false;
    }
    frame.size = static_cast<std::uint8_t>(size);
  }
  return text.size() <= 2 || (text.size() == 4 && text[2] == '_' && hex_digit(text[3]) > 8);
}

/// "1401552A#D2040000000700C0". CAN FD has a second '#' behind the first, CAN XL one behind colons.
bool take_compact(std::string_view word, std::size_t hash, LogLine& line) {
  const auto payload = word.substr(hash + 1);
  if (const auto second = payload.find('#'); second != std::string_view::npos) {
    line.kind = LogLine::Kind::other;
    return second == 0 || payload.substr(0, second).find(':') != std::string_view::npos;
  }
  if ((hash != standard_digits && hash != extended_digits) ||
      !take_id(word.substr(0, hash), line)) {
    return false;
  }
  return payload.starts_with('R') ? take_remote(payload, line.frame)
                                  : take_data(payload, line.frame);
}

/// `-x` adds the direction in both formats: " T" and " R", or "  RX - -" before the ID.
bool is_direction(std::string_view word) {
  return word == "T" || word == "R";
}

/// "1401552A   [8]  D2 04 …" from the ID on. CAN FD has a length of two digits. Text after the data
/// (`-a`: as characters, `-e`: ERRORFRAME) adds nothing. Data in reverse order (`-S`) has a mark in
/// place of the spaces and is refused.
bool take_screen(std::string_view id, Scanner& in, LogLine& line) {
  const auto length = in.word();
  const bool brackets = length.size() >= 3 && length.front() == '[' && length.back() == ']';
  if (!brackets || !take_id(id, line)) {
    return false;
  }
  const auto digits = length.substr(1, length.size() - 2);
  if (!std::ranges::all_of(digits, is_decimal)) {
    return false;
  }
  if (digits.size() == 2) {
    line.kind = LogLine::Kind::other;
    return true;
  }
  Frame& frame = line.frame;
  frame.size = static_cast<std::uint8_t>(digits.front() - '0');
  if (digits.size() != 1 || frame.size > frame.data.size()) {
    return false;
  }
  const auto first = in.word();
  if (first == "remote") {
    frame.remote = true;
    return in.word() == "request";
  }
  auto byte = first;
  for (std::size_t i = 0; i < frame.size; ++i) {
    const auto value = byte.size() == 2 ? hex_number(byte) : std::nullopt;
    if (!value) {
      return false;
    }
    frame.data[i] = static_cast<std::uint8_t>(*value);
    byte = in.word();
  }
  return true;
}

/// candump explains error frames (`-e`) on lines that begin with a tab, and reports how many frames
/// it lost (`-d`).
bool is_remark(std::string_view text) {
  return text.find_first_not_of(" \t") == std::string_view::npos || text.front() == '\t' ||
         text.starts_with("DROPCOUNT: ");
}

/// Reads everything after the time stamp and the interface.
bool take_frame(Scanner& in, LogLine& line) {
  auto word = in.word();
  if (const auto hash = word.find('#'); hash != std::string_view::npos) {
    const auto direction = in.word();
    in.skip_spaces();
    return take_compact(word, hash, line) &&
           (direction.empty() || (is_direction(direction) && in.rest().empty()));
  }
  if (word == "RX" || word == "TX") {
    in.word(); // bit rate switch and error state indicator, of CAN FD
    in.word();
    word = in.word();
  }
  return take_screen(word, in, line);
}

/// Writes upper-case hexadecimal digits, as candump does.
char* put_hex(char* out, std::uint32_t value, std::size_t digits) {
  for (std::size_t i = digits; i-- > 0;) {
    *out++ = "0123456789ABCDEF"[value >> (4 * i) & 0xF];
  }
  return out;
}

/// Writes at least `width` decimal digits.
char* put_decimal(char* out, std::uint64_t value, std::size_t width) {
  std::array<char, 20> digits{};
  std::size_t size = 0;
  do {
    digits[size++] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value != 0 || size < width);
  return std::reverse_copy(digits.begin(), digits.begin() + static_cast<std::ptrdiff_t>(size), out);
}

} // namespace

std::optional<LogLine> parse_line(std::string_view text) {
  while (text.ends_with('\n') || text.ends_with('\r')) {
    text.remove_suffix(1);
  }
  LogLine line;
  Scanner in(text);
  in.skip_spaces();
  if (in.skip('(') && !take_stamp(in, line)) {
    return std::nullopt;
  }
  line.interface = in.word();
  if (!line.interface.empty() && take_frame(in, line)) {
    return line;
  }
  return is_remark(text) ? std::optional(LogLine()) : std::nullopt;
}

std::string_view format_line(const Frame& frame, WallTime at, std::string_view interface,
                             LineBuffer& buffer) {
  constexpr std::uint64_t million = 1'000'000;
  const auto micros =
      static_cast<std::uint64_t>(std::max(at.time_since_epoch(), Duration()).count());
  char* out = buffer.data();
  *out++ = '(';
  out = put_decimal(out, micros / million, absolute_digits);
  *out++ = '.';
  out = put_decimal(out, micros % million, micro_digits);
  *out++ = ')';
  *out++ = ' ';
  out = std::ranges::copy(interface.substr(0, longest_interface_name), out).out;
  *out++ = ' ';
  out = put_hex(out, frame.id, frame.extended ? extended_digits : standard_digits);
  *out++ = '#';
  if (frame.remote) {
    *out++ = 'R';
    out = frame.size > 0 ? put_decimal(out, std::min<unsigned>(frame.size, 8), 1) : out;
  } else {
    for (const std::uint8_t byte : frame.payload()) {
      out = put_hex(out, byte, 2);
    }
  }
  *out++ = '\n';
  return {buffer.data(), out};
}

} // namespace blactl::can
