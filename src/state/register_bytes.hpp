#pragma once
// Registers as bytes in a database.

#include "blactl/state/registers.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace blactl::state {

/// Nine bytes a register, ascending by address: the address, and the number (64 bits, two's
/// complement, the highest byte first).
[[nodiscard]] std::vector<std::uint8_t> bytes_of(const Registers& registers);

/// Null: that is not what bytes_of() makes.
[[nodiscard]] std::optional<Registers> registers_of(std::span<const std::uint8_t> bytes);

} // namespace blactl::state
