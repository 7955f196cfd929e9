#include "blactl/fleet/line/counter_check.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/address.hpp"
#include "blactl/dronecan/ids.hpp"

#include "fleet/line/station_texts.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

namespace blactl::fleet {

using dronecan::UniqueId;

namespace {

bool gives(const Counter& counter, const state::PassedIds& ids) {
  const auto& held =
      counter.parameter->address == bla::address::servo_id ? ids.servo_id : ids.static_node_id;
  return held && *held >= counter.first && *held <= counter.last;
}

} // namespace

Result<void> check_counters(const state::LedgerStore& ledger, const state::CounterStore& counters,
                            const Recipe& recipe) {
  const auto passed = ledger.passed(recipe.name);
  if (!passed) {
    return std::unexpected(passed.error());
  }
  std::set<UniqueId> unknown;
  for (const Counter& counter : recipe.counters) {
    const auto known = counters.units(recipe.name, std::string(counter.parameter->name));
    if (!known) {
      return std::unexpected(known.error());
    }
    for (const auto& [text, ids] : *passed) {
      const auto unit = from_hex<std::tuple_size_v<UniqueId>>(text);
      if (unit && gives(counter, ids) && !std::ranges::binary_search(*known, *unit)) {
        unknown.insert(*unit);
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
