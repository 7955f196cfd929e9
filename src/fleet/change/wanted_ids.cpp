#include "blactl/fleet/change/wanted_ids.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/id_texts.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;
using Wish = state::AllocationStore::Wish;

namespace {

std::optional<dronecan::UniqueId> whole_unique_id(const Targets& whom) {
  const bool is_unique_id =
      whom.selectors.size() == 1 && whom.selectors.front().key == Selector::Key::unique_id;
  return is_unique_id
             ? from_hex<std::tuple_size_v<dronecan::UniqueId>>(whom.selectors.front().value)
             : std::nullopt;
}

/// Those on the bus, and those that wait and have told all of their unique ID.
std::set<dronecan::UniqueId> units_with(const Targets& whom, const Roster& roster,
                                        const bla::Profiles& profiles) {
  std::set<dronecan::UniqueId> units;
  for (const auto& [id, member] : roster.members()) {
    const auto unique_id = member.unique_id();
    if (unique_id && roster.heard(id) && whom.mean(member, profiles)) {
      units.insert(*unique_id);
    }
  }
  for (const UniqueIdPrefix& asking : roster.pending()) {
    dronecan::UniqueId unique_id{};
    const bool is_meant = asking.size() == unique_id.size() &&
                          std::ranges::any_of(whom.selectors, [&](const Selector& selector) {
                            return selector.key == Selector::Key::unique_id &&
                                   hex(asking).starts_with(selector.value);
                          });
    if (is_meant) {
      std::ranges::copy(asking, unique_id.begin());
      units.insert(unique_id);
    }
  }
  return units;
}

/// Those that wait, of whose unique ID only the beginning was heard.
std::string perhaps_meant(const Targets& whom, const Roster& roster) {
  std::string listed;
  for (const Selector& selector : whom.selectors) {
    for (const UniqueIdPrefix& heard : waiting_like(selector, roster)) {
      if (heard.size() < std::tuple_size_v<dronecan::UniqueId>) {
        listed += ", " + say<texts::waiting_unit>("uid:" + hex(heard));
      }
    }
  }
  return listed;
}

using Serials = std::map<dronecan::UniqueId, std::int64_t>;

Result<Serials> serial_numbers(const Roster& roster, std::span<const Wish> wishes) {
  Serials serials;
  for (const Wish& wish : wishes) {
    const auto number = roster.member(wish.node_id).servo().identity.readings().serial_number;
    if (!number) {
      return std::unexpected(Error{Code::timeout,
                                   say<texts::range_needs_serials>(wish.node_id.value()),
                                   say<texts::range_needs_serials_hint>(), wish.node_id.value()});
    }
    serials.emplace(wish.unique_id, *number);
  }
  return serials;
}

/// What 0x46 holds counts as used, but not by the servo that is to move: it is of a try that broke
/// off.
void give_up_promise(const Roster& roster, NodeId id, state::NodeIds& used) {
  const auto promised = roster.member(id).static_node_id.value_or(0);
  const bool is_id = promised > 0 && promised <= NodeId::max;
  if (is_id && !roster.heard(NodeId(static_cast<std::uint8_t>(promised)))) {
    used.reset(static_cast<std::size_t>(promised));
  }
}

} // namespace

bool names_one_unit(const WantedId& wanted) {
  return whole_unique_id(wanted.whom).has_value();
}

Result<dronecan::UniqueId> unit_meant(const WantedId& wanted, const Roster& roster,
                                      const bla::Profiles& profiles) {
  if (const auto whole = whole_unique_id(wanted.whom)) {
    return *whole;
  }
  for (const NodeId id : wanted.whom.ids) {
    if (roster.is_doubled(id)) {
      return std::unexpected(doubled(roster, id));
    }
  }
  const auto units = units_with(wanted.whom, roster, profiles);
  const std::string waiting = perhaps_meant(wanted.whom, roster);
  if (units.size() == 1 && waiting.empty()) {
    return *units.begin();
  }
  if (units.empty()) {
    return fail(Code::not_found, say<texts::nothing_matches>(printable(wanted.text)),
                say<texts::node_not_found_hint>());
  }
  std::string listed;
  for (const dronecan::UniqueId& unit : units) {
    listed += (listed.empty() ? "uid:" : ", uid:") + hex(unit);
  }
  listed += waiting;
  return fail(Code::usage, say<texts::several_wanted>(printable(wanted.text), listed),
              say<texts::several_wanted_hint>());
}

UnitsMeant units_meant(std::span<const WantedId> wanted, const Roster& roster,
                       const bla::Profiles& profiles) {
  UnitsMeant found;
  for (const WantedId& each : wanted) {
    auto unit = unit_meant(each, roster, profiles);
    if (!unit) {
      found.errors.push_back(std::move(unit.error()));
    } else if (std::ranges::find(found.wishes, *unit, &Wish::unique_id) != found.wishes.end()) {
      found.errors.push_back({Code::usage,
                              say<texts::wished_twice>(printable(each.text), hex(*unit)),
                              say<texts::wished_twice_hint>(), std::nullopt});
    } else {
      found.wishes.push_back({*unit, each.node_id});
    }
  }
  return found;
}

Result<std::vector<Wish>> ids_within(const AllocationService::Range& range, const Roster& roster,
                                     std::span<const NodeId> nodes,
                                     const std::set<dronecan::UniqueId>& newcomers) {
  auto wishes = ids_as_they_are(roster, nodes);
  auto serials =
      wishes ? serial_numbers(roster, *wishes) : Result<Serials>(std::unexpected(wishes.error()));
  if (!serials) {
    return std::unexpected(std::move(serials.error()));
  }
  std::ranges::sort(*wishes, {}, [&](const Wish& wish) {
    return std::pair(serials->at(wish.unique_id), wish.unique_id);
  });
  state::NodeIds used = roster.ids_in_use({});
  std::vector<Wish*> movers;
  for (Wish& wish : *wishes) {
    const bool is_inside = range.first <= wish.node_id && wish.node_id <= range.last;
    const bool is_new = newcomers.contains(wish.unique_id);
    if (!is_inside || is_new) {
      movers.push_back(&wish);
      give_up_promise(roster, wish.node_id, used);
    }
    if (is_new) {
      used.reset(wish.node_id.value());
    }
  }
  std::size_t moved = 0;
  for (std::size_t id = range.first.value(); id <= range.last.value(); ++id) {
    if (!used[id] && moved < movers.size()) {
      movers[moved++]->node_id = NodeId(static_cast<std::uint8_t>(id));
    }
  }
  return moved == movers.size()
             ? std::move(wishes)
             : fail(Code::table_full,
                    say<texts::range_too_small>(range.first.value(), range.last.value(), moved,
                                                movers.size()),
                    say<texts::range_too_small_hint>());
}

Result<std::vector<Wish>> ids_as_they_are(const Roster& roster, std::span<const NodeId> nodes) {
  std::vector<Wish> wishes;
  for (const NodeId id : nodes) {
    const Member member = roster.member(id);
    if (roster.is_doubled(id)) {
      return std::unexpected(doubled(roster, id));
    }
    if (!member.info) {
      return std::unexpected(silent(roster, id));
    }
    wishes.push_back({member.info->unique_id, id});
  }
  return wishes;
}

Result<void> may_have(const Roster& roster, const dronecan::UniqueId& unit, NodeId id) {
  if (roster.is_doubled(id)) {
    return std::unexpected(doubled(roster, id));
  }
  const Member member = roster.member(id);
  const bool is_other = roster.heard(id) && !member.is_unit(unit);
  if (!is_other && id != roster.local()) {
    return {};
  }
  return std::unexpected(Error{Code::duplicate_node_id,
                               say<texts::wished_id_in_use>(id.value(), hex(unit)),
                               say<texts::wished_id_in_use_hint>(), id.value()});
}

} // namespace blactl::fleet
