#include "cli/line/line_stores.hpp"

#include "cli/line/texts.hpp"
#include "cli/stores.hpp"

#include <string>

namespace blactl::cli {

Result<void> check_line_stores(const state::LedgerStore& ledger,
                               const state::CounterStore& counters, std::string_view interface) {
  const std::string folder = printable(stores_folder(interface));
  bool has_records = false; // else it was just made
  const auto read = ledger.each({}, [&](const state::LedgerRecord&) {
    has_records = true;
    return false;
  });
  if (!read) {
    return read;
  }
  if (has_records && !counters.is_there()) {
    return fail(Code::state, say<texts::counters_lost>(folder),
                say<texts::counters_lost_hint>(folder));
  }
  if (counters.is_there() && !ledger.is_there()) {
    return fail(Code::state, say<texts::ledger_lost>(folder), say<texts::ledger_lost_hint>(folder));
  }
  return {};
}

} // namespace blactl::cli
