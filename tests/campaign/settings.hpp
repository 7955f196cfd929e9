#pragma once
// Settings that episodes ask for, as typed, and the register numbers they stand for by the tables
// of the specification.

#include <cstdint>
#include <map>
#include <string>

namespace blactl::campaign {

struct Setting {
  std::uint8_t address = 0;
  std::map<std::string, std::int64_t> values; ///< by what is typed
};

/// Values that every model takes, for registers that neither drive the shaft nor change IDs.
[[nodiscard]] const std::map<std::string, Setting>& settings();

} // namespace blactl::campaign
