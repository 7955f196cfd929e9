#pragma once
// Dates of logs that name no time zone.

#include "blactl/base/time.hpp"

#include <chrono>
#include <optional>

namespace blactl::can {

/// The last year of a date in a log: whatever time is added, candump's stamps have room for it.
inline constexpr unsigned last_year = 2999;

/// When a clock of this process's time zone shows this. Empty: before 1970.
[[nodiscard]] std::optional<WallTime> from_local(std::chrono::local_time<Duration> shown);

} // namespace blactl::can
