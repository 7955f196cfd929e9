#pragma once
// What stands behind `-i mcast:` (contract, section 2): N[?if=IFACE].

#include "blactl/base/error.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::cli {

struct McastName {
  std::uint8_t bus_number = 0;
  std::string link{}; ///< the network interface; empty: whichever the machine would take
};

/// "0?if=lo". The number alone is enough, and so is nothing: bus 0. Errors: usage.
[[nodiscard]] Result<McastName> parse_mcast(std::string_view text);

} // namespace blactl::cli
