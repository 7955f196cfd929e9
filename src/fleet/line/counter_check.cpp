#include "blactl/fleet/line/counter_check.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/address.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/line/line_record.hpp"

#include "fleet/line/station_texts.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace blactl::fleet {

using dronecan::UniqueId;
using state::LedgerRecord;

namespace {

/// What units hold that have passed by a recipe, and were not taken out since.
using Passed = std::map<UniqueId, LedgerRecord>;

Result<Passed> passed_by(const state::LedgerStore& ledger, const Recipe& recipe) {
  Passed passed;
  const auto read = ledger.each({.recipe = recipe.name}, [&](const LedgerRecord& record) {
    constexpr std::size_t size = std::tuple_size_v<UniqueId>;
    const auto unit = from_hex<size>(record.unique_id.value_or(""));
    if (unit && record.verdict == verdict::pass) {
      passed.insert_or_assign(*unit, record);
    } else if (unit && record.verdict == verdict::scrap) {
      passed.erase(*unit);
    }
    return true;
  });
  return read ? Result<Passed>(std::move(passed)) : std::unexpected(read.error());
}

bool gives(const Counter& counter, const LedgerRecord& record) {
  const auto& held = counter.parameter->address == bla::address::servo_id ? record.servo_id
                                                                          : record.static_node_id;
  return held && *held >= counter.first && *held <= counter.last;
}

} // namespace

Result<void> check_counters(const state::LedgerStore& ledger, const state::CounterStore& counters,
                            const Recipe& recipe) {
  const auto passed = passed_by(ledger, recipe);
  if (!passed) {
    return std::unexpected(passed.error());
  }
  std::set<UniqueId> unknown;
  for (const Counter& counter : recipe.counters) {
    const auto known = counters.units(recipe.name, std::string(counter.parameter->name));
    if (!known) {
      return std::unexpected(known.error());
    }
    for (const auto& [unit, record] : *passed) {
      if (gives(counter, record) && !known->contains(unit)) {
        unknown.insert(unit);
      }
    }
  }
  return unknown.empty() ? Result<void>()
                         : fail(Code::state,
                                say<texts::counters_behind>(unknown.size(), printable(recipe.name),
                                                            hex(*unknown.begin())),
                                say<texts::counters_behind_hint>());
}

} // namespace blactl::fleet
