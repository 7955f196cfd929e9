#pragma once
// Rounding to whole units.

#include <cstdint>

namespace blactl::sim {

/// The multiple of `unit` nearest to `value`, halves upwards, so that values a whole number of
/// units apart stay so.
[[nodiscard]] constexpr std::int64_t rounded(std::int64_t value, std::int64_t unit) {
  const std::int64_t raised = value + unit / 2;
  return raised >= 0 ? raised / unit : -((unit - 1 - raised) / unit);
}

} // namespace blactl::sim
