#pragma once
// The formats of all state files, each defined beside its store.

#include "state/database_file.hpp"

#include <cstdint>

namespace blactl::state {

/// The last time in any of them: microseconds since 1970, UTC, at the end of the year 9999.
inline constexpr std::int64_t last_time = 253402300799999999;

[[nodiscard]] const DatabaseFormat& allocations_format();
[[nodiscard]] const DatabaseFormat& counters_format();
[[nodiscard]] const DatabaseFormat& ledger_format();
[[nodiscard]] const DatabaseFormat& proofs_format();
[[nodiscard]] const DatabaseFormat& snapshots_format();

} // namespace blactl::state
