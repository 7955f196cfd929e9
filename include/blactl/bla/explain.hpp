#pragma once
// Registers in words where a number and its unit are not enough.

#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::bla {

/// When a servo was made (0x58-0x5C, 4.44): "2025-06-22 15:30"; without the time where its
/// registers are not among `values` or hold none. Empty: there is no such date, or it is not known
/// as a whole.
[[nodiscard]] std::optional<std::string> production_time(const Values& values);

/// What a bit of a fault register is called; null: one that no document describes.
[[nodiscard]] std::string bit_title(const FaultBit* known);

/// What one of `values` tells beyond its number, line by line: of a fault register the bits that
/// are set (4.12), of the last register of the date of production the whole date; of others
/// nothing.
[[nodiscard]] std::vector<std::string> explained(const Parameter& parameter, std::int64_t raw,
                                                 const Values& values, const Profiles& profiles);

} // namespace blactl::bla
