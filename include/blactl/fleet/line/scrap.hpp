#pragma once
// Takes a unit of a production line out, so that its IDs are given to another one (contract,
// section 7, "Ledger").

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/state/counter_store.hpp"
#include "blactl/state/ledger_record.hpp"
#include "blactl/state/ledger_store.hpp"

#include <string>

namespace blactl::fleet {

/// The record with this ID. Errors: not_found; state: it names no unit; those of the ledger.
[[nodiscard]] Result<state::LedgerRecord> record_to_scrap(const state::LedgerStore& ledger,
                                                          const std::string& record_id);

/// Records that the unit of `record` is taken out, and frees the IDs that it has by that recipe;
/// where an earlier run has only recorded it, frees them. `common`: who says so. Returns the record
/// in the ledger. Errors: busy: a station works on the unit; those of both stores.
[[nodiscard]] Result<state::LedgerRecord>
scrap(state::LedgerStore& ledger, state::CounterStore& counters, const state::LedgerRecord& record,
      const state::LedgerRecord& common, std::string reason, WallTime now);

} // namespace blactl::fleet
