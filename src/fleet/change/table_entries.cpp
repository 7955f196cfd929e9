#include "blactl/fleet/change/table_entries.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/id_holders.hpp"
#include "fleet/change/id_texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

using Wish = state::AllocationStore::Wish;

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

bool may_be_on_bus(const Roster& roster, const state::AllocationEntry& entry) {
  const bool is_somebody = roster.heard(entry.node_id) &&
                           (!roster.member(entry.node_id).info || roster.is_doubled(entry.node_id));
  return is_here(roster, entry.unique_id) || roster.is_pending(entry.unique_id) || is_somebody;
}

Result<void> enter_seen(state::AllocationStore& table, const Roster& roster, Time now,
                        WallTime wall) {
  std::vector<Wish> seen;
  for (const auto& [id, member] : roster.members()) {
    const bool is_here = member.is_servo && member.info && now - member.last_heard < offline_time &&
                         !roster.is_doubled(id) && !not_unique(roster, id);
    if (!is_here) { // it may have moved, and left this ID
      continue;
    }
    const auto known = table.find(member.info->unique_id);
    if (!known) {
      return std::unexpected(known.error());
    }
    if (member.static_node_id == id.value() || !*known || (*known)->node_id == id) {
      seen.push_back({member.info->unique_id, id});
    }
  }
  return enter_kept(table, seen, wall);
}

Result<void> enter_kept(state::AllocationStore& table, std::span<const Wish> kept, WallTime now) {
  return table.enter(kept, now, state::AllocationStore::Former::yields);
}

} // namespace blactl::fleet
