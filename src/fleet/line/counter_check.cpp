#include "blactl/fleet/line/counter_check.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/address.hpp"
#include "blactl/dronecan/ids.hpp"

#include "fleet/line/station_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
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

Result<void> check_own_id(const Recipe& recipe, dronecan::NodeId own) {
  const auto refused = [&](std::int64_t first, std::int64_t last) {
    const std::string ids =
        first == last ? std::to_string(first) : fmt::format("{}-{}", first, last);
    return fail(Code::usage, say<texts::own_id_is_given>(own.value(), ids),
                say<texts::own_id_is_given_hint>(ids));
  };
  for (const Counter& counter : recipe.counters) {
    const bool is_within = own.value() >= counter.first && own.value() <= counter.last;
    if (counter.parameter->address == bla::address::static_node_id && is_within &&
        (own.value() - counter.first) % counter.step == 0) {
      return refused(counter.first, counter.last);
    }
  }
  for (const bla::Assignment& each : recipe.set) {
    if (each.parameter->address == bla::address::static_node_id && each.value.raw == own.value()) {
      return refused(own.value(), own.value());
    }
  }
  return {};
}

} // namespace blactl::fleet
