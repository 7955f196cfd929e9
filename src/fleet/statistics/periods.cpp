#include "blactl/fleet/statistics/periods.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blactl::fleet {

void Periods::take(Time at) {
  const auto last = std::exchange(last_, at);
  if (!last || at < *last) {
    return;
  }
  const Duration period = at - *last;
  min_ = count_ == 0 ? period : std::min(min_, period);
  max_ = std::max(max_, period);
  ++count_;
  const auto us = static_cast<double>(period.count());
  const double before = us - mean_;
  mean_ += before / static_cast<double>(count_);
  squares_ += before * (us - mean_);
}

std::optional<double> Periods::mean_us() const {
  return count_ > 0 ? std::optional(mean_) : std::nullopt;
}

std::optional<Duration> Periods::min() const {
  return count_ > 0 ? std::optional(min_) : std::nullopt;
}

std::optional<Duration> Periods::max() const {
  return count_ > 0 ? std::optional(max_) : std::nullopt;
}

std::optional<double> Periods::jitter_us() const {
  return count_ > 1 ? std::optional(std::sqrt(squares_ / static_cast<double>(count_)))
                    : std::nullopt;
}

} // namespace blactl::fleet
