#pragma once
// Register values as plain data.

#include "blactl/bla/address.hpp"

#include <cstdint>
#include <map>
#include <optional>

namespace blactl::bla {

/// Register values by address; absent ones are unknown.
using Values = std::map<Address, std::int64_t>;

/// Empty: unknown.
[[nodiscard]] inline std::optional<std::int64_t> find(const Values& values, Address address) {
  const auto it = values.find(address);
  return it != values.end() ? std::optional(it->second) : std::nullopt;
}

} // namespace blactl::bla
