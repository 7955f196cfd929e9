#pragma once
// Registers in words, if a number and its unit are not enough.

#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::bla {

/// The servo's date of production (0x58-0x5C, 4.44): "2025-06-22 15:30"; without the time if its
/// registers are not among `values` or hold none. Empty: the date is invalid or not fully known.
[[nodiscard]] std::optional<std::string> production_time(const Values& values);

/// The title of a bit of a fault register; null: an undocumented bit.
[[nodiscard]] std::string bit_title(const FaultBit* known);

/// Explains one of `values` beyond its number, line by line: for a fault register the bits set
/// (4.12), for the last register of the date of production the whole date; else nothing.
[[nodiscard]] std::vector<std::string> explained(const Parameter& parameter, std::int64_t raw,
                                                 const Values& values, const Profiles& profiles);

} // namespace blactl::bla
