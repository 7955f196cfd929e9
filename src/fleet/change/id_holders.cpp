#include "fleet/change/id_holders.hpp"

#include <algorithm>
#include <optional>

namespace blactl::fleet {

using Wish = state::AllocationStore::Wish;

namespace {

bool moves(const dronecan::UniqueId& unit, std::span<const Wish> wishes) {
  return std::ranges::find(wishes, unit, &Wish::unique_id) != wishes.end();
}

} // namespace

std::vector<IdHolder> holders(const Roster& roster, std::span<const Wish> wishes) {
  std::vector<IdHolder> units;
  for (const auto& [id, member] : roster.members()) {
    if (!roster.heard(id) || !member.info) {
      continue;
    }
    const auto& unique_id = member.info->unique_id;
    const IdHolder unit{unique_id, id,
                        moves(unique_id, wishes) ? std::nullopt : member.static_node_id};
    const auto same = std::ranges::find(units, unique_id, &IdHolder::unique_id);
    if (same == units.end()) {
      units.push_back(unit);
    } else if (roster.member(same->id).last_heard < member.last_heard) {
      *same = unit; // it has moved since
    }
  }
  return units;
}

std::optional<dronecan::NodeId> static_place(const Roster& roster,
                                             const dronecan::UniqueId& unique_id) {
  for (const auto& [id, member] : roster.members()) {
    if (member.is_unit(unique_id) && roster.heard(id) && member.static_node_id == id.value()) {
      return id;
    }
  }
  return std::nullopt;
}

Result<state::NodeIds> promised(const Roster& roster, const state::AllocationStore& table,
                                std::span<const Wish> wishes) {
  state::NodeIds ids;
  ids.set(roster.local().value());
  for (const auto& [id, member] : roster.members()) {
    ids.set(id.value(), roster.heard(id) && !member.info);
  }
  const auto entries = table.entries();
  if (!entries) {
    return std::unexpected(entries.error());
  }
  for (const state::AllocationEntry& entry : *entries) {
    if (!moves(entry.unique_id, wishes) && !roster.member(entry.node_id).is_unit(entry.unique_id) &&
        !static_place(roster, entry.unique_id)) {
      ids.set(entry.node_id.value());
    }
  }
  return ids;
}

} // namespace blactl::fleet
