#pragma once
// Who writes into the ledger.

#include "blactl/state/ledger_record.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

/// An option that was not given stays empty in a record.
[[nodiscard]] std::optional<std::string> unless_empty(const std::string& text);

/// Machine, station and version of this program; `station` empty: the machine's name.
[[nodiscard]] state::LedgerRecord record_of_station(const std::string& station);

} // namespace blactl::cli
