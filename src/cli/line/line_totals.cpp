#include "cli/line/line_totals.hpp"

#include "blactl/fleet/line/line_record.hpp"

#include "cli/line/texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace blactl::cli {

using state::LedgerRecord;

std::string text_of(const LineTotals& totals) {
  const auto count = [&](std::string_view verdict) {
    const auto found = totals.verdicts.find(std::string(verdict));
    return found != totals.verdicts.end() ? found->second : 0;
  };
  const auto yield = totals.first_pass_yield();
  return say<texts::station_totals>(count(fleet::verdict::pass), count(fleet::verdict::fail),
                                    count(fleet::verdict::error), count(fleet::verdict::skip)) +
         (yield ? " " + say<texts::station_yield>(fmt::format("{:.1f}", *yield)) : std::string());
}

std::string numbers_of(const std::vector<LineTotals::Owed>& owed) {
  std::string numbers;
  for (const LineTotals::Owed& each : owed) {
    numbers += (numbers.empty() ? "" : ", ") + each.number;
  }
  return numbers;
}

void LineTotals::add(const LedgerRecord& record) {
  ++verdicts[record.verdict.value_or("")];
  const bool is_result =
      record.verdict == fleet::verdict::pass || record.verdict == fleet::verdict::fail;
  if (is_result && record.unique_id) {
    first_passed.emplace(*record.unique_id, record.verdict == fleet::verdict::pass);
  }
  if (!record.unique_id) {
    return;
  }
  std::erase_if(owed, [&](const Owed& each) { return each.unit == *record.unique_id; });
  if (record.verdict == fleet::verdict::error && record.serial_number) {
    owed.push_back({*record.unique_id, std::to_string(*record.serial_number)});
  }
}

std::optional<double> LineTotals::first_pass_yield() const {
  if (first_passed.empty()) {
    return std::nullopt;
  }
  const auto passed =
      std::ranges::count_if(first_passed, [](const auto& unit) { return unit.second; });
  constexpr double percent = 100;
  return percent * static_cast<double>(passed) / static_cast<double>(first_passed.size());
}

} // namespace blactl::cli
