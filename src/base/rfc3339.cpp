#include "blactl/base/rfc3339.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

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
bool is_date(Reader& reader) {
  const auto year = reader.number(4);
  const auto month = year && reader.skip("-") ? reader.number(2) : std::nullopt;
  const auto day = month && reader.skip("-") ? reader.number(2) : std::nullopt;
  return day && std::chrono::year_month_day(std::chrono::year(*year),
                                            std::chrono::month(static_cast<unsigned>(*month)),
                                            std::chrono::day(static_cast<unsigned>(*day)))
                    .ok();
}

/// "HH:MM"
bool is_hours_and_minutes(Reader& reader) {
  const auto hours = reader.number(2);
  const auto minutes = hours && reader.skip(":") ? reader.number(2) : std::nullopt;
  return minutes && *hours < 24 && *minutes < 60;
}

/// partial-time; 60 is a leap second.
bool is_time_of_day(Reader& reader) {
  const auto seconds =
      is_hours_and_minutes(reader) && reader.skip(":") ? reader.number(2) : std::nullopt;
  return seconds && *seconds <= 60 && (!reader.skip(".") || reader.skip_digits());
}

} // namespace

bool is_rfc3339(std::string_view text) {
  Reader reader(text);
  return is_date(reader) && reader.skip("Tt") && is_time_of_day(reader) &&
         (reader.skip("Zz") || (reader.skip("+-") && is_hours_and_minutes(reader))) &&
         reader.is_at_end();
}

} // namespace blactl
