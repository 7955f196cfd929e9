#include "blactl/fleet/change/static_ids.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/id_holders.hpp"

#include <algorithm>
#include <string>
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

} // namespace

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

} // namespace blactl::fleet
