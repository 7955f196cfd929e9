#pragma once
// Rounding to whole units.

#include <cstdint>

namespace blactl::sim {

/// The whole number of `unit` that is nearest to `value`, halves upwards: so that values which are
/// whole units apart stay so.
[[nodiscard]] constexpr std::int64_t rounded(std::int64_t value, std::int64_t unit) {
  const std::int64_t raised = value + unit / 2;
  return raised >= 0 ? raised / unit : -((unit - 1 - raised) / unit);
}

} // namespace blactl::sim
