#include "fleet/change/id_holders.hpp"

#include <algorithm>
#include <optional>

namespace blactl::fleet {

using Wish = state::AllocationStore::Wish;

namespace {

bool moves(const dronecan::UniqueId& unit, std::span<const Wish> wishes) {
  return std::ranges::find(wishes, unit, &Wish::unique_id) != wishes.end();
}

/// The register of a member; empty: it is not known, or holds what the unit is to get, which ROM
/// may lack.
std::optional<std::int64_t> held_id(const Member& member, std::span<const Wish> wishes) {
  const auto wish = std::ranges::find(wishes, member.info->unique_id, &Wish::unique_id);
  const bool is_wanted = wish != wishes.end() && member.static_node_id == wish->node_id.value();
  return is_wanted ? std::nullopt : member.static_node_id;
}

} // namespace

bool is_here(const Roster& roster, const dronecan::UniqueId& unit) {
  return std::ranges::any_of(roster.members(), [&](const auto& entry) {
    return entry.second.is_unit(unit) && roster.heard(entry.first);
  });
}

std::vector<IdHolder> holders(const Roster& roster, std::span<const Wish> wishes) {
  std::vector<IdHolder> units;
  for (const auto& [id, member] : roster.members()) {
    if (!roster.heard(id) || !member.info) {
      continue;
    }
    const auto& unique_id = member.info->unique_id;
    const IdHolder unit{unique_id, id, held_id(member, wishes)};
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

Result<TakenIds> taken_ids(const Roster& roster, const state::AllocationStore& table,
                           std::span<const Wish> wishes) {
  TakenIds ids;
  ids.taken.set(roster.local().value());
  for (const auto& [id, member] : roster.members()) {
    ids.taken.set(id.value(), roster.heard(id) && !member.info);
  }
  const auto entries = table.entries();
  if (!entries) {
    return std::unexpected(entries.error());
  }
  for (const state::AllocationEntry& entry : *entries) {
    if (moves(entry.unique_id, wishes) || is_here(roster, entry.unique_id)) {
      continue; // its place is given by holders()
    }
    if (roster.is_pending(entry.unique_id)) { // it may get its ID at any moment
      ids.taken.set(entry.node_id.value());
    } else {
      ids.promised.set(entry.node_id.value());
      ids.absent.push_back(entry);
    }
  }
  return ids;
}

} // namespace blactl::fleet
