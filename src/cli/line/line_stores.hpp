#pragma once
// The ledger of a line and the table of the IDs given on it, which belong together.

#include "blactl/base/error.hpp"
#include "blactl/state/counter_store.hpp"
#include "blactl/state/ledger_store.hpp"

#include <string_view>

namespace blactl::cli {

/// `provision` makes both: if one of them is not there, it was lost. Both are open to read. Errors:
/// state; as LedgerStore::each().
[[nodiscard]] Result<void> check_line_stores(const state::LedgerStore& ledger,
                                             const state::CounterStore& counters,
                                             std::string_view interface);

} // namespace blactl::cli
