#include "blactl/fleet/change/static_ids.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/id_holders.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;
using Wish = state::AllocationStore::Wish;

namespace {

/// 0x46 written, and saved.
Result<Wanted> wanted_id(const bla::Profiles& profiles, NodeId id) {
  auto assignment = bla::make_assignment(profiles, bla::address::static_node_id.name(),
                                         std::to_string(id.value()));
  return assignment ? Result<Wanted>(
                          {.assignments = {std::move(*assignment)}, .restart = RestartKind::save})
                    : std::unexpected(assignment.error());
}

/// The reason why the node ID of a unit is unknown.
Error absence(const Roster& roster, const dronecan::UniqueId& unit, const NotLetIn& not_let_in) {
  for (const NodeId id : roster.doubled()) {
    const auto units = roster.units(id); // if neither was identified, it may be one of those
    if (units.empty() || units.contains(unit)) {
      return doubled(roster, id);
    }
  }
  if (const auto known = not_let_in.find(unit); known != not_let_in.end()) {
    return known->second;
  }
  const std::string named = "uid:" + hex(unit);
  return roster.is_pending(unit) ? Error{Code::not_found, say<texts::target_waits_for_id>(named),
                                         say<texts::target_waits_for_id_hint>(), std::nullopt}
                                 : Error{Code::not_found, say<texts::nothing_matches>(named),
                                         say<texts::node_not_found_hint>(), std::nullopt};
}

std::optional<dronecan::UniqueId> whole_unique_id(const Targets& whom) {
  const bool is_unique_id =
      whom.selectors.size() == 1 && whom.selectors.front().key == Selector::Key::unique_id;
  return is_unique_id
             ? from_hex<std::tuple_size_v<dronecan::UniqueId>>(whom.selectors.front().value)
             : std::nullopt;
}

/// Those on the bus, and those that wait and have told all of their unique ID.
std::set<dronecan::UniqueId> units_meant(const Targets& whom, const Roster& roster,
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

std::int64_t serial_number(const Roster& roster, NodeId id) {
  return roster.member(id).servo().identity.readings().serial_number.value_or(0);
}

} // namespace

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
  const auto units = units_meant(wanted.whom, roster, profiles);
  if (units.size() == 1) {
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
  return fail(Code::usage, say<texts::several_wanted>(printable(wanted.text), listed),
              say<texts::several_wanted_hint>());
}

Result<std::vector<Wish>> ids_within(const AllocationService::Range& range, const Roster& roster,
                                     std::span<const NodeId> nodes) {
  auto wishes = ids_as_they_are(roster, nodes);
  if (!wishes) {
    return wishes;
  }
  const auto is_inside = [&](NodeId id) { return range.first <= id && id <= range.last; };
  std::ranges::sort(*wishes, {}, [&](const Wish& wish) {
    return std::pair(serial_number(roster, wish.node_id), wish.unique_id);
  });
  const state::NodeIds used = roster.ids_in_use({});
  std::size_t movers = 0, free = 0;
  std::uint8_t next = range.first.value();
  for (Wish& wish : *wishes) {
    if (is_inside(wish.node_id)) {
      continue;
    }
    ++movers;
    while (next <= range.last.value() && used[next]) {
      ++next;
    }
    if (next <= range.last.value()) {
      ++free;
      wish.node_id = NodeId(next++);
    }
  }
  return free == movers ? std::move(wishes)
                        : fail(Code::table_full,
                               say<texts::range_too_small>(range.first.value(), range.last.value(),
                                                           free, movers),
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

StaticGoals static_goals(const Roster& roster, const bla::Profiles& profiles,
                         std::vector<Wish> wishes, const NotLetIn& not_let_in) {
  std::ranges::sort(wishes, {}, &Wish::node_id);
  const std::vector<IdHolder> units = holders(roster, wishes);
  StaticGoals found;
  for (const Wish& wish : wishes) {
    const auto unit = std::ranges::find(units, wish.unique_id, &IdHolder::unique_id);
    auto wanted = wanted_id(profiles, wish.node_id);
    if (unit == units.end()) {
      found.errors.push_back(absence(roster, wish.unique_id, not_let_in));
    } else if (!wanted) {
      found.errors.push_back(std::move(wanted.error()));
    } else {
      found.goals.push_back({.id = unit->id,
                             .unique_id = wish.unique_id,
                             .wanted = std::move(*wanted),
                             .evidence = Evidence::restart});
    }
  }
  return found;
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

Result<std::vector<std::string>> enter_wishes(state::AllocationStore& table,
                                              std::span<const Wish> wishes, WallTime now) {
  std::vector<std::string> notes;
  for (const Wish& wish : wishes) {
    const auto former = table.find(wish.node_id);
    if (!former) {
      return std::unexpected(former.error());
    }
    const bool moves = *former && std::ranges::find(wishes, (*former)->unique_id,
                                                    &Wish::unique_id) != wishes.end();
    if (*former && !moves) {
      notes.push_back(say<texts::wish_takes_over>(wish.node_id.value(), hex((*former)->unique_id),
                                                  hex(wish.unique_id)));
    }
  }
  const auto entered = table.enter(wishes, now, state::AllocationStore::Former::yields);
  return entered ? Result<std::vector<std::string>>(std::move(notes))
                 : std::unexpected(entered.error());
}

bool is_on_bus(const Roster& roster, const dronecan::UniqueId& unit) {
  return is_here(roster, unit) || roster.is_pending(unit);
}

std::vector<Wish> ids_seen(const Roster& roster) {
  std::vector<Wish> seen;
  for (const auto& [id, member] : roster.members()) {
    const bool is_one =
        member.is_servo && member.info && roster.heard(id) && !not_unique(roster, id);
    if (is_one && !roster.is_doubled(id)) {
      seen.push_back({member.info->unique_id, id});
    }
  }
  return seen;
}

Result<void> enter_kept(state::AllocationStore& table, std::span<const Wish> kept, WallTime now) {
  return table.enter(kept, now, state::AllocationStore::Former::yields);
}

} // namespace blactl::fleet
