#include "cli/trace/time.hpp"

#include <fmt/format.h>

#include <ctime>

namespace blactl::cli {

namespace {

constexpr std::int64_t micros_a_second = 1'000'000;

std::int64_t micros_of(WallTime at) {
  return std::max<std::int64_t>(at.time_since_epoch().count(), 0);
}

} // namespace

std::string clock_text(WallTime at) {
  const auto seconds = static_cast<std::time_t>(micros_of(at) / micros_a_second);
  std::tm parts{};
  if (localtime_r(&seconds, &parts) == nullptr) {
    return {}; // a year that does not fit into an int
  }
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", parts.tm_year + 1900, parts.tm_mon + 1,
                     parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec);
}

std::string wall_text(WallTime at) {
  const std::string clock = clock_text(at);
  return clock.empty() ? clock : fmt::format("{}.{:06}", clock, micros_of(at) % micros_a_second);
}

} // namespace blactl::cli
