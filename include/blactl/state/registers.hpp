#pragma once
// What registers of a servo held, as a store keeps it.

#include <cstdint>
#include <map>

namespace blactl::state {

/// Register numbers by address. What an address means this floor does not know: who reads them from
/// a file must judge them.
using Registers = std::map<std::uint8_t, std::int64_t>;

} // namespace blactl::state
