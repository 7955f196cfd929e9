#pragma once
// Register values of a servo, as kept by a store.

#include <cstdint>
#include <map>

namespace blactl::state {

/// Register values by address. This floor does not know the meaning of an address: the reader of a
/// file must check them.
using Registers = std::map<std::uint8_t, std::int64_t>;

} // namespace blactl::state
