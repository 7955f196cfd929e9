#include "can/log/asc.hpp"

#include "can/log/local_time.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <tuple>

namespace blactl::can {
namespace {

constexpr std::size_t micro_places = 6;

/// Of the field "flags" of CAN FD's format: it is a remote frame, it is one of CAN FD.
constexpr std::uint32_t remote_flag = 0x10;
constexpr std::uint32_t fd_flag = 0x1000;

/// Longer than this no log runs, and the sum of two of them is still a time.
constexpr Duration longest_log = std::chrono::hours(24) * 366 * 1000;

using WordList = std::span<const std::string_view>;

constexpr std::array<std::string_view, 13> weekdays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat",
                                                    "Son", "Die", "Mit", "Don", "Fre", "Sam"};

constexpr std::array<std::string_view, 12> english_months{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
/// "Mär" in UTF-8; the others are as in English where they are the same.
constexpr std::array<std::string_view, 12> german_months{
    "Jan", "Feb", "M\xC3\xA4r", "Apr", "Mai", "Jun", "Jul", "Aug", "Sep", "Okt", "Nov", "Dez"};
/// "Mär" as Windows writes it (code page 1252), and another abbreviation.
constexpr std::array<std::string_view, 2> german_march{"M\xE4r", "Mrz"};

bool is_one_of(std::string_view word, WordList names) {
  return std::ranges::any_of(names, [&](auto name) { return same_word(word, name); });
}

std::optional<std::chrono::month> month_named(std::string_view word) {
  for (const WordList names : {WordList(english_months), WordList(german_months)}) {
    const auto found =
        std::ranges::find_if(names, [&](auto name) { return same_word(word, name); });
    if (found != names.end()) {
      return std::chrono::month(static_cast<unsigned>(found - names.begin()) + 1);
    }
  }
  return is_one_of(word, german_march) ? std::optional(std::chrono::March) : std::nullopt;
}

/// "15:06:13.191", "15:06:13".
std::optional<Duration> time_of_day(std::string_view text) {
  constexpr std::size_t hours_at = 0, minutes_at = 3, seconds_at = 6, fraction_at = 8;
  if (text.size() < fraction_at || text[minutes_at - 1] != ':' || text[seconds_at - 1] != ':') {
    return std::nullopt;
  }
  const auto hour = whole_number(text.substr(hours_at, 2), 23);
  const auto minute = whole_number(text.substr(minutes_at, 2), 59);
  const auto second = whole_number(text.substr(seconds_at, 2), 59);
  const auto fraction = text.substr(fraction_at);
  if (!hour || !minute || !second ||
      (!fraction.empty() && (fraction[0] != '.' || !are_digits(fraction.substr(1))))) {
    return std::nullopt;
  }
  return std::chrono::hours(*hour) + std::chrono::minutes(*minute) + std::chrono::seconds(*second) +
         Duration(fraction.empty() ? 0 : scaled(fraction.substr(1), micro_places));
}

/// An hour of twelve that `half` ("am", "pm") completes.
std::optional<Duration> of_half_day(Duration time, std::string_view half) {
  constexpr std::chrono::hours noon(12), hour(1);
  const bool is_pm = same_word(half, "pm");
  if ((!is_pm && !same_word(half, "am")) || time < hour || time >= noon + hour) {
    return std::nullopt;
  }
  return (time >= noon ? time - noon : time) + (is_pm ? noon : std::chrono::hours());
}

/// "Sat Sep 30 15:06:13.191 2017", "Sat Sep 30 03:06:13 pm 2017".
std::optional<WallTime> date(Words& in) {
  const auto weekday = in.next();
  const auto month = month_named(in.next());
  const auto day = whole_number(in.next(), 31);
  auto time = time_of_day(in.next());
  auto year_word = in.next();
  if (time && !are_digits(year_word)) {
    time = of_half_day(*time, year_word);
    year_word = in.next();
  }
  const auto year = whole_number(year_word, last_year);
  if (!is_one_of(weekday, weekdays) || !month || !day || !time || !year || !in.next().empty()) {
    return std::nullopt;
  }
  const std::chrono::year_month_day days(std::chrono::year(static_cast<int>(*year)), *month,
                                         std::chrono::day(*day));
  return days.ok() ? from_local(std::chrono::local_days(days) + *time) : std::nullopt;
}

bool says_direction(std::string_view word) {
  return is_one_of(word, std::array<std::string_view, 3>{"Rx", "Tx", "TxRq"});
}

/// A code from 0 to 15 in one hexadecimal digit.
std::optional<std::uint8_t> length_code(std::string_view word) {
  const int code = word.size() == 1 ? hex_digit(word.front()) : -1;
  return code < 0 ? std::nullopt : std::optional(static_cast<std::uint8_t>(code));
}

/// Codes above eight mean eight bytes too.
std::uint8_t size_of(std::uint8_t code) {
  return std::min<std::uint8_t>(code, std::tuple_size_v<decltype(Frame::data)>);
}

/// What is known of an error frame: that there was one.
void make_error(LogLine& line) {
  line.kind = LogLine::Kind::error;
  line.frame = {.id = CAN_ERR_BUSERROR, .size = CAN_ERR_DLC};
}

enum class FdContent : std::uint8_t { unreadable, classic, fd };

bool is_bit(std::string_view word) {
  return word == "0" || word == "1";
}

/// "8 D2 04 …": the length and the data, of which a classic frame has room for eight bytes.
std::optional<std::uint32_t> take_fd_data(Words& in, Frame& frame) {
  constexpr std::uint32_t longest_data = 64;
  const auto size = whole_number(in.next(), longest_data);
  for (std::size_t i = 0; i < size.value_or(0); ++i) {
    const auto value = hex_byte(in.next());
    if (!value) {
      return std::nullopt;
    }
    if (i < frame.data.size()) {
      frame.data[i] = static_cast<std::uint8_t>(*value);
    }
  }
  return size;
}

/// "[NAME] 0 0 8 8 D2 04 … 130000 130 0": the flags at its end tell CAN FD from classic CAN.
FdContent take_fd_content(Words& in, Frame& frame) {
  const auto first = in.next();
  const auto rate_switch = is_bit(first) ? first : in.next();
  const auto state = in.next();
  const auto code = length_code(in.next());
  const auto size = take_fd_data(in, frame);
  in.next(); // duration
  in.next(); // bits
  const auto flags = hex_word(in.next());
  if (!is_bit(rate_switch) || !is_bit(state) || !code || !size || !flags) {
    return FdContent::unreadable;
  }
  if ((*flags & fd_flag) != 0) {
    return FdContent::fd;
  }
  frame.remote = (*flags & remote_flag) != 0;
  frame.size = size_of(*code);
  return *size == (frame.remote ? 0U : frame.size) ? FdContent::classic : FdContent::unreadable;
}

} // namespace

bool AscLog::begins(std::string_view line) {
  Words in(without_line_end(line));
  const auto first = in.next();
  const auto second = in.next();
  return (same_word(first, "date") && is_one_of(second, weekdays)) ||
         (same_word(first, "base") && (same_word(second, "hex") || same_word(second, "dec")));
}

std::optional<LogLine> AscLog::parse(std::string_view text) {
  Words in(without_line_end(text));
  const auto first = in.next();
  if (first.empty() || first.starts_with("//")) {
    return LogLine();
  }
  if (is_decimal(first.front())) {
    return event(first, in);
  }
  return take_header(first, in) ? std::optional(LogLine()) : std::nullopt;
}

/// A line without a time.
bool AscLog::take_header(std::string_view first, Words& in) {
  if (same_word(first, "date")) {
    start_ = date(in);
    elapsed_ = Duration();
    return start_.has_value();
  }
  if (same_word(first, "base")) {
    return take_base(in);
  }
  const auto second = in.next();
  if (same_word(first, "begin") && same_word(second, "triggerblock")) {
    block_ = date(in);
    return true;
  }
  return (same_word(first, "end") && same_word(second, "triggerblock")) ||
         (same_word(first, "internal") && same_word(second, "events")) ||
         (same_word(first, "no") && same_word(second, "internal"));
}

/// "hex  timestamps absolute" behind "base".
bool AscLog::take_base(Words& in) {
  const auto base = in.next();
  const auto what = in.next();
  const auto from = in.next();
  base_ = same_word(base, "hex") ? Base::hex : same_word(base, "dec") ? Base::dec : Base::unknown;
  adds_up_ = same_word(from, "relative");
  if (!same_word(what, "timestamps") || (!adds_up_ && !same_word(from, "absolute"))) {
    base_ = Base::unknown;
  }
  return base_ != Base::unknown;
}

/// "0.015991". `date` is when the logger was started; the measurement began with the block that
/// holds its start, and only the block says when if there is no date.
bool AscLog::take_time(std::string_view word, Words rest, LogLine& line) {
  const auto read = DecimalFraction::parse(word);
  if (!read) {
    return false;
  }
  const Duration time =
      std::chrono::seconds(read->whole) + Duration(scaled(read->fraction, micro_places));
  if (time > longest_log || (adds_up_ && time > longest_log - elapsed_)) {
    return false;
  }
  elapsed_ = adds_up_ ? elapsed_ + time : time;
  const bool is_start = same_word(rest.next(), "Start") && same_word(rest.next(), "of");
  if (block_ && (!start_ || is_start)) {
    start_ = *block_ - elapsed_;
  }
  block_.reset();
  line.stamp = start_ ? LogLine::Stamp::absolute : LogLine::Stamp::relative;
  line.at = start_.value_or(WallTime()) + elapsed_;
  return true;
}

/// A line with a time: a frame, or anything else that CANoe logs, such as statistics, variables
/// and other buses.
std::optional<LogLine> AscLog::event(std::string_view time, Words& in) {
  LogLine line;
  const auto what = in;
  auto word = in.next();
  if (base_ == Base::unknown || word.empty() || !take_time(time, what, line)) {
    return std::nullopt;
  }
  const bool is_read = same_word(word, "CANFD")   ? take_fd(in, line)
                       : is_decimal(word.front()) ? take_classic(word, in, line)
                                                  : true;
  return is_read ? std::optional(line) : std::nullopt;
}

bool AscLog::take_channel(std::string_view word, LogLine& line) {
  const auto channel = whole_number(word, most_channel);
  line.interface = channel ? channel_.set(*channel) : std::string_view();
  return channel.has_value();
}

/// "1  1401552Ax  Rx  d 8 D2 04 …", "1  1401552Ax  Rx  r 8", "1  ErrorFrame"; text behind them
/// adds nothing. Other lines of a channel ("1  Statistic: …") have neither a number nor a
/// direction.
bool AscLog::take_classic(std::string_view channel, Words& in, LogLine& line) {
  const auto id = in.next();
  if (!take_channel(channel, line)) {
    return false;
  }
  if (same_word(id, "ErrorFrame")) {
    make_error(line);
    return true;
  }
  const auto direction = in.next();
  const bool has_id = take_id(id, base_, line.frame);
  if (!says_direction(direction)) {
    return !has_id && !direction.empty();
  }
  const auto kind = in.next();
  line.kind = same_word(direction, "TxRq") ? LogLine::Kind::other : LogLine::Kind::frame;
  if (same_word(kind, "r")) {
    line.frame.remote = true;
    line.frame.size = size_of(length_code(in.next()).value_or(0));
    return has_id;
  }
  return has_id && same_word(kind, "d") && take_data(in, line.frame);
}

/// "1401552Ax" is extended, "7FF" is standard.
bool AscLog::take_id(std::string_view word, Base base, Frame& frame) const {
  frame.extended = word.ends_with('x') || word.ends_with('X');
  word.remove_suffix(frame.extended ? 1 : 0);
  const std::uint32_t most = frame.extended ? extended_id_mask : standard_id_mask;
  const auto id = base == Base::dec ? whole_number(word, most) : hex_word(word);
  frame.id = id.value_or(0);
  return id && *id <= most;
}

/// "8 D2 04 …" behind the "d".
bool AscLog::take_data(Words& in, Frame& frame) const {
  const auto code = length_code(in.next());
  if (!code) {
    return false;
  }
  frame.size = size_of(*code);
  for (std::size_t i = 0; i < frame.size; ++i) {
    const auto value = byte(in.next());
    if (!value) {
      return false;
    }
    frame.data[i] = static_cast<std::uint8_t>(*value);
  }
  return !byte(in.next()); // it has more data than it says
}

std::optional<std::uint32_t> AscLog::byte(std::string_view word) const {
  return base_ == Base::dec ? whole_number(word, 0xFF) : hex_byte(word);
}

/// "1 Rx 1401552Ax [NAME] 0 0 8 8 D2 04 … 130000 130 0 …" behind "CANFD": channel, direction, ID,
/// a name, two bits, length code, length, data, duration, bits and flags, all but the length
/// hexadecimal in every log. A channel that can do CAN FD logs its classic frames so too.
bool AscLog::take_fd(Words& in, LogLine& line) {
  const bool has_channel = take_channel(in.next(), line);
  const auto direction = in.next();
  const auto id = in.next();
  if (!has_channel || !says_direction(direction)) {
    return false;
  }
  if (same_word(id, "ErrorFrame")) {
    make_error(line);
    return true;
  }
  const auto content =
      take_id(id, Base::hex, line.frame) ? take_fd_content(in, line.frame) : FdContent::unreadable;
  if (content == FdContent::classic && !same_word(direction, "TxRq")) {
    line.kind = LogLine::Kind::frame;
  }
  return content != FdContent::unreadable;
}

} // namespace blactl::can
