#pragma once
// Times in records and files (contract, section 5).

#include "blactl/base/time.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace blactl {

/// "2026-11-21T08:15:00Z": RFC 3339, UTC, whole seconds.
[[nodiscard]] inline std::string rfc3339(WallTime time) {
  using namespace std::chrono;
  const auto seconds = floor<std::chrono::seconds>(time);
  const auto day = floor<days>(seconds);
  const year_month_day date(day);
  const hh_mm_ss clock(seconds - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

/// A date-time of RFC 3339, section 5.6, in any time zone, to the second; empty: it is none.
[[nodiscard]] std::optional<WallTime> parse_rfc3339(std::string_view text);

} // namespace blactl
