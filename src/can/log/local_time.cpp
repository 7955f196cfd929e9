#include "can/log/local_time.hpp"

#include <ctime>

namespace blactl::can {

std::optional<WallTime> from_local(std::chrono::local_time<Duration> shown) {
  const auto day = std::chrono::floor<std::chrono::days>(shown);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(shown - day);
  std::tm parts{};
  parts.tm_year = static_cast<int>(date.year()) - 1900;
  parts.tm_mon = static_cast<int>(static_cast<unsigned>(date.month())) - 1;
  parts.tm_mday = static_cast<int>(static_cast<unsigned>(date.day()));
  parts.tm_hour = static_cast<int>(time.hours().count());
  parts.tm_min = static_cast<int>(time.minutes().count());
  parts.tm_sec = static_cast<int>(time.seconds().count());
  parts.tm_isdst = -1; // the time zone knows
  const std::time_t seconds = std::mktime(&parts);
  if (seconds < 0) {
    return std::nullopt;
  }
  return WallTime(std::chrono::seconds(seconds)) + time.subseconds();
}

} // namespace blactl::can
