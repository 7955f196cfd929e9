#pragma once
// What a production line may give: IDs that its table of assigned IDs knows (contract, section 6:
// within one lap of a counter no ID is given twice), and not that of the station itself.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/files/recipe.hpp"
#include "blactl/state/counter_store.hpp"
#include "blactl/state/ledger_store.hpp"

namespace blactl::fleet {

/// Looks for units that have passed by this recipe, hold an ID that its counters give, and are not
/// in the table: that was lost, or is an old copy. Errors: state: there are some; those of both
/// stores.
[[nodiscard]] Result<void> check_counters(const state::LedgerStore& ledger,
                                          const state::CounterStore& counters,
                                          const Recipe& recipe);

/// Whether this recipe ever gives a servo the node ID `own`. Errors: usage: it does.
[[nodiscard]] Result<void> check_own_id(const Recipe& recipe, dronecan::NodeId own);

} // namespace blactl::fleet
