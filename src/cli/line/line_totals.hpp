#pragma once
// What a run of a station has come to.

#include "blactl/state/ledger_record.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// The results of a run.
struct LineTotals {
  /// A unit whose last record is an error: it has to come back.
  struct Owed {
    std::string unit, number; ///< unique ID, serial number
  };

  std::map<std::string, std::uint64_t> verdicts{};
  std::map<std::string, bool> first_passed{}; ///< by unit: whether its first result was a pass

  std::vector<Owed> owed{}; ///< each once

  void add(const state::LedgerRecord& record);

  /// In percent; empty: no unit has a result yet.
  [[nodiscard]] std::optional<double> first_pass_yield() const;
};

/// "pass 3 fail 0 error 1 skip 0 first pass 100.0%"
[[nodiscard]] std::string text_of(const LineTotals& totals);

/// "104, 105"
[[nodiscard]] std::string numbers_of(const std::vector<LineTotals::Owed>& owed);

} // namespace blactl::cli
