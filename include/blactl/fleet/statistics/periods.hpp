#pragma once
// How regularly something comes.

#include "blactl/base/time.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// The times between one and the next. A time before the last one (a clock that was set) ends no
/// period, and begins the next. In microseconds, as they were measured; nothing is left out, so a
/// transfer that was lost shows as a long period.
class Periods {
 public:
  void take(Time at);

  /// Periods, one fewer than times where none went back.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// Empty, as all below: there is none.
  [[nodiscard]] std::optional<double> mean_us() const;
  [[nodiscard]] std::optional<Duration> min() const;
  [[nodiscard]] std::optional<Duration> max() const;

  /// The standard deviation of all of them; empty: there are not two.
  [[nodiscard]] std::optional<double> jitter_us() const;

 private:
  std::optional<Time> last_;
  std::uint64_t count_ = 0;
  double mean_ = 0, squares_ = 0; ///< squares of the distances from the mean (Welford)
  Duration min_{}, max_{};
};

} // namespace blactl::fleet
