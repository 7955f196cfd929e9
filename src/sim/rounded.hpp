#pragma once
// Rounding to whole units.

#include <cstdint>

namespace blactl::sim {

/// The whole number of `unit` that is nearest to `value`, halves away from 0.
[[nodiscard]] constexpr std::int64_t rounded(std::int64_t value, std::int64_t unit) {
  return (value >= 0 ? value + unit / 2 : value - unit / 2) / unit;
}

} // namespace blactl::sim
