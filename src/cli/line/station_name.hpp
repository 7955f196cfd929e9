#pragma once
// Who writes into the ledger.

#include "blactl/state/ledger_record.hpp"

#include <string>

namespace blactl::cli {

/// Machine, station and version of this program; `station` empty: the machine's name.
[[nodiscard]] state::LedgerRecord record_of_station(const std::string& station);

} // namespace blactl::cli
