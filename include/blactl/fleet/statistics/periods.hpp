#pragma once
// Statistics of the periods of an event.

#include "blactl/base/time.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// The times between consecutive events. An event earlier than the one before (a clock was set)
/// ends no period, but begins the next. In microseconds, as measured; nothing is omitted, so that a
/// lost transfer shows as a long period.
class Periods {
 public:
  void take(Time at);

  /// The number of periods: one less than the events, if no clock went back.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// Empty, as all below: there are no periods.
  [[nodiscard]] std::optional<double> mean_us() const;
  [[nodiscard]] std::optional<Duration> min() const;
  [[nodiscard]] std::optional<Duration> max() const;

  /// The standard deviation; empty: there are fewer than two periods.
  [[nodiscard]] std::optional<double> jitter_us() const;

 private:
  std::optional<Time> last_;
  std::uint64_t count_ = 0;
  double mean_ = 0, squares_ = 0; ///< squares of the distances from the mean (Welford)
  Duration min_{}, max_{};
};

} // namespace blactl::fleet
