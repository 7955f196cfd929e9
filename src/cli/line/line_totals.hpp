#pragma once
// What a run of a station has come to.

#include "blactl/state/ledger_record.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace blactl::cli {

/// The results of a run.
struct LineTotals {
  std::map<std::string, std::uint64_t> verdicts{};
  std::map<std::string, bool> first_passed{}; ///< by unit: whether its first result was a pass

  void add(const state::LedgerRecord& record);

  /// In percent; empty: no unit has a result yet.
  [[nodiscard]] std::optional<double> first_pass_yield() const;
};

/// "pass 3 fail 0 error 1 skip 0 first pass 100.0%"
[[nodiscard]] std::string text_of(const LineTotals& totals);

} // namespace blactl::cli
