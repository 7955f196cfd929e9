#pragma once
// Dates of logs that name no time zone.

#include "blactl/base/time.hpp"

#include <chrono>
#include <optional>

namespace blactl::can {

/// When a clock of this process's time zone shows this. Empty: before 1970.
[[nodiscard]] std::optional<WallTime> from_local(std::chrono::local_time<Duration> shown);

} // namespace blactl::can
