#pragma once
// Registers as bytes in a database.

#include "blactl/state/registers.hpp"

#include "state/sqlite.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace blactl::state {

/// Nine bytes per register, ascending by address: the address and the value (64 bits, two's
/// complement, most significant byte first).
[[nodiscard]] inline std::vector<std::uint8_t> bytes_of(const Registers& registers) {
  std::vector<std::uint8_t> bytes;
  for (const auto& [address, number] : registers) {
    bytes.push_back(address);
    for (unsigned shift = 64; shift > 0;) {
      shift -= 8;
      bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> shift));
    }
  }
  return bytes;
}

/// The inverse of bytes_of(); null: invalid bytes.
[[nodiscard]] inline std::optional<Registers> registers_of(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t number_size = 8;
  Registers registers;
  for (; bytes.size() > number_size; bytes = bytes.subspan(1 + number_size)) {
    const std::uint8_t address = bytes.front();
    if (!registers.empty() && address <= registers.rbegin()->first) {
      return std::nullopt;
    }
    std::uint64_t number = 0;
    for (const std::uint8_t byte : bytes.subspan(1, number_size)) {
      number = number << 8U | byte;
    }
    registers.emplace(address, static_cast<std::int64_t>(number));
  }
  return bytes.empty() ? std::optional(std::move(registers)) : std::nullopt;
}

/// The registers in a column; rejects invalid bytes.
[[nodiscard]] inline Registers registers_in(Statement& row, int column) {
  auto registers = registers_of(row.bytes(column));
  if (!registers) {
    row.reject();
  }
  return std::move(registers).value_or(Registers());
}

} // namespace blactl::state
