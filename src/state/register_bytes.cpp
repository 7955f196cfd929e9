#include "state/register_bytes.hpp"

#include <cstddef>

namespace blactl::state {
namespace {

constexpr std::size_t number_size = 8;
constexpr std::size_t register_size = 1 + number_size;
constexpr unsigned byte_bits = 8;

std::int64_t number_of(std::span<const std::uint8_t, number_size> bytes) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : bytes) {
    number = number << byte_bits | byte;
  }
  return static_cast<std::int64_t>(number);
}

} // namespace

std::vector<std::uint8_t> bytes_of(const Registers& registers) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(registers.size() * register_size);
  for (const auto& [address, number] : registers) {
    bytes.push_back(address);
    for (std::size_t i = number_size; i-- > 0;) {
      bytes.push_back(
          static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (i * byte_bits)));
    }
  }
  return bytes;
}

std::optional<Registers> registers_of(std::span<const std::uint8_t> bytes) {
  Registers registers;
  for (; bytes.size() >= register_size; bytes = bytes.subspan(register_size)) {
    const std::uint8_t address = bytes.front();
    if (!registers.empty() && address <= registers.rbegin()->first) {
      return std::nullopt;
    }
    registers.emplace(address, number_of(bytes.subspan<1, number_size>()));
  }
  return bytes.empty() ? std::optional(std::move(registers)) : std::nullopt;
}

} // namespace blactl::state
