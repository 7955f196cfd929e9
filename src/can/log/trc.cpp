#include "can/log/trc.hpp"

#include "can/log/local_time.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace blactl::can {
namespace {

// The columns by their letters: N number, O offset in milliseconds, T type, B bus, I ID, d
// direction, R reserved, L length code, l length, D data. Version 1 has no $COLUMNS: its direction
// is also "Warng" or "Error".
constexpr std::string_view columns_1_1 = "NOdILD";
constexpr std::string_view columns_1_2 = "NOBdILD";
constexpr std::string_view columns_1_3 = "NOBdIRLD";
constexpr std::string_view all_columns = "NOTBIdRLlD";

constexpr std::string_view version_key = ";$FILEVERSION=";
constexpr std::string_view start_key = ";$STARTTIME=";
constexpr std::string_view columns_key = ";$COLUMNS=";

constexpr std::size_t milli_places = 3;
constexpr std::uint32_t most_length_code = 15;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto first = std::min(text.find_first_not_of(blanks), text.size());
  text.remove_prefix(first);
  return text.substr(0, text.find_last_not_of(blanks) + 1); // npos + 1 is 0
}

/// Days since 1899-12-30, cut to microseconds.
std::optional<std::chrono::local_time<Duration>> ole_date(std::string_view text) {
  constexpr std::int64_t most_days = 401'768; // the end of the year 2999
  const auto days = DecimalFraction::parse(text);
  if (!days || days->whole > most_days) {
    return std::nullopt;
  }
  // A day has 864e8 microseconds: eight digits are whole ones, those behind are parts of them.
  constexpr std::size_t whole_places = 8, more_places = 10;
  constexpr std::int64_t unit = 864, more = 10'000'000'000;
  const auto fraction = days->fraction;
  const auto rest = fraction.substr(std::min(whole_places, fraction.size()));
  const auto micros =
      scaled(fraction, whole_places) * unit + scaled(rest, more_places) * unit / more;
  constexpr std::chrono::local_days epoch{std::chrono::year(1899) / std::chrono::December / 30};
  return epoch + std::chrono::days(days->whole) + Duration(micros);
}

/// Whether a column may stand behind these. Lines that are no frames leave out words from the ID
/// on, so what says so must stand before it, and so must the time.
bool may_follow(char column, std::string_view before) {
  const bool is_length = column == 'L' || column == 'l';
  return all_columns.contains(column) && !before.contains(column) && !before.contains('D') &&
         (column != 'I' || (before.contains('O') && before.contains('T'))) &&
         (!is_length || before.find_first_of("Ll") == std::string_view::npos);
}

bool are_complete(std::string_view columns) {
  return columns.contains('I') && columns.contains('D') &&
         columns.find_first_of("Ll") != std::string_view::npos;
}

/// Types of messages that are no frames of classic CAN: CAN FD, the adapter's status, its error
/// counters, remarks.
bool is_other_type(std::string_view type) {
  return std::ranges::any_of(
      std::array<std::string_view, 7>{"FD", "FB", "FE", "BI", "ST", "EC", "EV"},
      [&](auto other) { return type == other; });
}

/// The first byte of the data where words before it may be missing: "Rx    04 …", "- Rx -  5  04
/// …".
std::optional<std::uint32_t> first_byte(Words& in) {
  for (auto word = in.next(); !word.empty(); word = in.next()) {
    if (const auto byte = hex_byte(word)) {
      return byte;
    }
  }
  return std::nullopt;
}

/// "04 00 02 00 00": type, direction, place in the frame, and the counters. Places and the bits of
/// the type are those of linux/can/error.h.
void make_error(std::uint32_t type, std::uint32_t place, LogLine& line) {
  line.kind = LogLine::Kind::error;
  line.frame = {.id = CAN_ERR_PROT | CAN_ERR_BUSERROR, .size = CAN_ERR_DLC};
  constexpr std::uint32_t known = CAN_ERR_PROT_BIT | CAN_ERR_PROT_FORM | CAN_ERR_PROT_STUFF;
  line.frame.data[2] = static_cast<std::uint8_t>(type & known);
  line.frame.data[3] = static_cast<std::uint8_t>(place);
}

/// "1)" in version 1, "1" in version 2.
bool is_message_number(std::string_view word) {
  word.remove_suffix(word.ends_with(')') ? 1 : 0);
  return are_digits(word);
}

/// "0300" is standard, "1401552A" is extended. python-can writes seven digits if they are enough.
bool take_trc_id(std::string_view text, Frame& frame) {
  frame.extended = text.size() != 4;
  const auto id = hex_word(text);
  frame.id = id.value_or(0);
  return id && *id <= (frame.extended ? extended_id_mask : standard_id_mask) &&
         (!frame.extended || text.size() >= 7);
}

} // namespace

class TrcLog::Fields {
 public:
  /// Takes the words of `columns` up to D; only those up to the ID if there may be no ID.
  Fields(std::string_view columns, Words& in) {
    for (const char column : columns) {
      if (column == 'D' || (column == 'I' && !may_be_frame())) {
        return;
      }
      words_[all_columns.find(column)] = in.next();
    }
  }

  [[nodiscard]] std::string_view operator[](char column) const {
    return words_[all_columns.find(column)];
  }

 private:
  [[nodiscard]] bool may_be_frame() const {
    const auto type = (*this)['T'];
    return type.empty() || type == "DT" || type == "RR";
  }

  std::array<std::string_view, all_columns.size()> words_{};
};

bool TrcLog::begins(std::string_view line) {
  return line.starts_with(version_key);
}

std::optional<LogLine> TrcLog::parse(std::string_view text) {
  text = trimmed(text);
  if (text.empty()) {
    return LogLine();
  }
  if (text.starts_with(';')) {
    return take_keyword(text) ? std::optional(LogLine()) : std::nullopt;
  }
  return message(text);
}

/// A line that begins with a semicolon; all but three kinds are comments.
bool TrcLog::take_keyword(std::string_view line) {
  if (line.starts_with(version_key)) {
    return take_version(line.substr(version_key.size()));
  }
  if (line.starts_with(start_key)) {
    return take_start(line.substr(start_key.size()));
  }
  return !line.starts_with(columns_key) || take_columns(line.substr(columns_key.size()));
}

bool TrcLog::take_version(std::string_view version) {
  start_.reset();
  has_types_ = version == "2.0" || version == "2.1";
  set_columns(version == "1.1"   ? columns_1_1
              : version == "1.2" ? columns_1_2
              : version == "1.3" ? columns_1_3
                                 : std::string_view());
  return has_types_ || !columns().empty();
}

void TrcLog::set_columns(std::string_view columns) {
  columns_size_ = columns.copy(letters_.data(), letters_.size());
}

/// PEAK's document ends it with a semicolon in one place.
bool TrcLog::take_start(std::string_view days) {
  days.remove_suffix(days.ends_with(';') ? 1 : 0);
  const auto shown = ole_date(days);
  start_ = shown ? from_local(*shown) : std::nullopt;
  return start_.has_value();
}

/// "N,O,T,B,I,d,R,L,D", of version 2.
bool TrcLog::take_columns(std::string_view list) {
  set_columns({});
  if (!has_types_) {
    return false;
  }
  for (std::size_t i = 0; i < list.size(); i += 2) {
    const bool is_separated = i + 1 == list.size() || list[i + 1] == ',';
    if (!is_separated || columns_size_ == letters_.size() || !may_follow(list[i], columns())) {
      set_columns({});
      return false;
    }
    letters_[columns_size_++] = list[i];
  }
  if (!are_complete(columns())) {
    set_columns({});
  }
  return !columns().empty();
}

std::optional<LogLine> TrcLog::message(std::string_view text) {
  Words in(text);
  const Fields fields(columns(), in);
  const auto offset = DecimalFraction::parse(fields['O']);
  const bool has_number = !columns().contains('N') || is_message_number(fields['N']);
  if (!offset || !has_number) { // also if the columns are not known
    return std::nullopt;
  }
  LogLine line;
  line.stamp = start_ ? LogLine::Stamp::absolute : LogLine::Stamp::relative;
  line.at = start_.value_or(WallTime()) + std::chrono::milliseconds(offset->whole) +
            Duration(scaled(offset->fraction, milli_places));
  const bool is_read =
      has_types_ ? take_second_version(fields, in, line) : take_first_version(fields, in, line);
  return is_read ? std::optional(line) : std::nullopt;
}

/// "Rx  0300  3  RTR" is a remote frame. The ID of an error frame is its type, its data is
/// direction, place and counters.
bool TrcLog::take_first_version(const Fields& fields, Words& data, LogLine& line) {
  const auto direction = fields['d'];
  if (direction == "Error") {
    const auto type = hex_word(fields['I']);
    data.next(); // direction
    make_error(type.value_or(0), hex_byte(data.next()).value_or(0), line);
    return type.has_value();
  }
  if (direction == "Warng") {
    return true;
  }
  Words ahead = data;
  const bool is_remote = ahead.next() == "RTR";
  return (direction == "Rx" || direction == "Tx") &&
         take_frame(fields, is_remote ? ahead : data, is_remote, line);
}

bool TrcLog::take_second_version(const Fields& fields, Words& data, LogLine& line) {
  const auto type = fields['T'];
  if (type == "ER") {
    const auto error_type = first_byte(data);
    data.next(); // direction
    make_error(error_type.value_or(0), hex_byte(data.next()).value_or(0), line);
    return error_type.has_value();
  }
  return is_other_type(type) ||
         ((type == "DT" || type == "RR") && take_frame(fields, data, type == "RR", line));
}

bool TrcLog::take_frame(const Fields& fields, Words& data, bool is_remote, LogLine& line) {
  const bool has_buses = columns().contains('B');
  const auto bus = whole_number(fields['B'], most_channel);
  line.interface = has_buses && bus ? channel_.set(*bus) : channel_.unnumbered();
  line.kind = LogLine::Kind::frame;
  Frame& frame = line.frame;
  const auto most = static_cast<std::uint32_t>(frame.data.size());
  const auto length = columns().contains('l') ? whole_number(fields['l'], most)
                                              : whole_number(fields['L'], most_length_code);
  if ((has_buses && !bus) || !take_trc_id(fields['I'], frame) || !length) {
    return false;
  }
  frame.remote = is_remote;
  frame.size = static_cast<std::uint8_t>(std::min(*length, most)); // codes above eight mean eight
  for (std::size_t i = 0; i < frame.size && !is_remote; ++i) {
    const auto value = hex_byte(data.next());
    if (!value) {
      return false;
    }
    frame.data[i] = static_cast<std::uint8_t>(*value);
  }
  return data.next().empty();
}

} // namespace blactl::can
