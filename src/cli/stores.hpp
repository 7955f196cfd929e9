#pragma once
// The stores for the servos behind an interface (contract, section 6): those of this user;
// simulated servos, which would fill them, have some of their own, and a private simulation has
// them in memory.

#include "blactl/base/error.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/state/allocation_store.hpp"
#include "blactl/state/counter_store.hpp"
#include "blactl/state/ledger_store.hpp"
#include "blactl/state/snapshot_store.hpp"

#include <string>
#include <string_view>

namespace blactl::cli {

/// The folder of the stores behind `interface`; empty: this user has none. A private simulation
/// leaves that of the user alone.
[[nodiscard]] std::string stores_folder(std::string_view interface);

/// The allocation table. Errors: as AllocationStore::open().
[[nodiscard]] Result<state::AllocationStore> open_allocations(std::string_view interface,
                                                              state::Access access);

/// The record of what `command` changes. Errors: as SnapshotStore::open().
[[nodiscard]] Result<fleet::History> open_history(std::string_view interface,
                                                  std::string_view command, state::Access access);

/// The changes that were recorded. Errors: as SnapshotStore::open().
[[nodiscard]] Result<state::SnapshotStore> open_snapshots(std::string_view interface,
                                                          state::Access access);

/// The records of the production line. Errors: as LedgerStore::open().
[[nodiscard]] Result<state::LedgerStore> open_ledger(std::string_view interface,
                                                     state::Access access);

/// The IDs given on it. Errors: as CounterStore::open().
[[nodiscard]] Result<state::CounterStore> open_counters(std::string_view interface,
                                                        state::Access access);

} // namespace blactl::cli
