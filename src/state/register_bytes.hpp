#pragma once
// Registers as bytes in a database.

#include "blactl/state/registers.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace blactl::state {

/// Nine bytes per register, ascending by address: the address and the value (64 bits, two's
/// complement, most significant byte first).
[[nodiscard]] std::vector<std::uint8_t> bytes_of(const Registers& registers);

/// The inverse of bytes_of(); null: invalid bytes.
[[nodiscard]] std::optional<Registers> registers_of(std::span<const std::uint8_t> bytes);

} // namespace blactl::state
