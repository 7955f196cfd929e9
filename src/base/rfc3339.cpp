#include "blactl/base/rfc3339.hpp"

#include <algorithm>
#include <charconv>

namespace blactl {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Reads a text from its front; an empty result: the text is malformed.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool is_at_end() const { return rest_.empty(); }

  [[nodiscard]] bool skip(std::string_view any_of) {
    const bool fits = !rest_.empty() && any_of.find(rest_.front()) != std::string_view::npos;
    rest_.remove_prefix(fits ? 1 : 0);
    return fits;
  }

  [[nodiscard]] std::optional<int> number(std::size_t digits) {
    const std::string_view text = rest_.substr(0, digits);
    if (text.size() != digits || !std::ranges::all_of(text, is_digit)) {
      return std::nullopt;
    }
    int value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    rest_.remove_prefix(digits);
    return value;
  }

  /// Skips at least one digit.
  [[nodiscard]] bool skip_digits() {
    const auto digits = std::ranges::find_if_not(rest_, is_digit) - rest_.begin();
    rest_.remove_prefix(static_cast<std::size_t>(digits));
    return digits > 0;
  }

 private:
  std::string_view rest_;
};

/// full-date
std::optional<std::chrono::sys_days> date_of(Reader& reader) {
  const auto year = reader.number(4);
  const auto month = year && reader.skip("-") ? reader.number(2) : std::nullopt;
  const auto day = month && reader.skip("-") ? reader.number(2) : std::nullopt;
  if (!day) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date(std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  return date.ok() ? std::optional(std::chrono::sys_days(date)) : std::nullopt;
}

/// "HH:MM"
std::optional<std::chrono::minutes> hours_and_minutes(Reader& reader) {
  const auto hours = reader.number(2);
  const auto minutes = hours && reader.skip(":") ? reader.number(2) : std::nullopt;
  return minutes && *hours < 24 && *minutes < 60
             ? std::optional(std::chrono::hours(*hours) + std::chrono::minutes(*minutes))
             : std::nullopt;
}

/// partial-time; 60 is a leap second. Parts of a second are left out.
std::optional<std::chrono::seconds> time_of_day(Reader& reader) {
  const auto minutes = hours_and_minutes(reader);
  const auto seconds = minutes && reader.skip(":") ? reader.number(2) : std::nullopt;
  return seconds && *seconds <= 60 && (!reader.skip(".") || reader.skip_digits())
             ? std::optional(*minutes + std::chrono::seconds(*seconds))
             : std::nullopt;
}

/// time-offset
std::optional<std::chrono::minutes> offset(Reader& reader) {
  if (reader.skip("Zz")) {
    return std::chrono::minutes(0);
  }
  const bool is_east = reader.skip("+");
  const auto distance = is_east || reader.skip("-") ? hours_and_minutes(reader) : std::nullopt;
  return distance && !is_east ? std::optional(-*distance) : distance;
}

} // namespace

std::optional<WallTime> parse_rfc3339(std::string_view text) {
  Reader reader(text);
  const auto date = date_of(reader);
  const auto time = date && reader.skip("Tt") ? time_of_day(reader) : std::nullopt;
  const auto east = time ? offset(reader) : std::nullopt;
  return east && reader.is_at_end() ? std::optional<WallTime>(*date + *time - *east) : std::nullopt;
}

} // namespace blactl
