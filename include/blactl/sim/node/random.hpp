#pragma once
// Pseudo-random numbers: the same seed gives the same numbers with every compiler and library.

#include "blactl/base/time.hpp"

#include <cstdint>

namespace blactl::sim {

/// SplitMix64 (Steele, Lea, Flood 2014): one word of state, good enough for jitter and faults.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EB;
    return z ^ (z >> 31U);
  }

  /// True with this probability. A probability of 0 or 1 does not advance the sequence.
  [[nodiscard]] bool chance(double probability) {
    if (probability <= 0 || probability >= 1) {
      return probability >= 1;
    }
    constexpr double steps = 9007199254740992.0; // 2^53, the precision of a double
    return static_cast<double>(next() >> 11U) < probability * steps;
  }

  /// Any duration from `low` to `high`, both included.
  [[nodiscard]] Duration between(Duration low, Duration high) {
    const auto span = static_cast<std::uint64_t>((high - low).count()) + 1;
    return low + Duration(static_cast<Duration::rep>(next() % span));
  }

 private:
  std::uint64_t state_;
};

/// The seed of the `index`th of several things that share one seed.
[[nodiscard]] inline std::uint64_t seed_of(std::uint64_t seed, std::uint64_t index) {
  return Random(seed ^ Random(index).next()).next();
}

} // namespace blactl::sim
