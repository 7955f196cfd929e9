#pragma once
// What registers hold, as plain data.

#include "blactl/bla/address.hpp"

#include <cstdint>
#include <map>
#include <optional>

namespace blactl::bla {

/// Register numbers by address; what is not there is not known.
using Values = std::map<Address, std::int64_t>;

/// Empty: not known.
[[nodiscard]] inline std::optional<std::int64_t> find(const Values& values, Address address) {
  const auto it = values.find(address);
  return it != values.end() ? std::optional(it->second) : std::nullopt;
}

} // namespace blactl::bla
