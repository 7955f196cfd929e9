#include "blactl/fleet/change/former_ids.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/change/allocation_service.hpp"

#include "fleet/change/id_texts.hpp"

#include <algorithm>
#include <ranges>
#include <span>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;
using dronecan::UniqueId;

bool FormerIds::serves(dronecan::Bytes prefix) const {
  return std::ranges::any_of(ids_ | std::views::keys, [&](const UniqueId& unique_id) {
    return dronecan::begins_with(unique_id, prefix);
  });
}

std::optional<NodeId> FormerIds::assign(const UniqueId& unique_id, NodeId /*preferred*/) {
  const auto former = ids_.find(unique_id);
  if (former == ids_.end()) {
    return std::nullopt;
  }
  const NodeId id = from_table(unique_id, former->second).value_or(former->second);
  // another unit may have taken the ID in the meantime, and not be identified yet
  const Member* now = session_.roster().find(id);
  const bool is_taken = now != nullptr && !now->is_unit(unique_id);
  Asked& asked = asked_[unique_id];
  asked.id = id;
  asked.given += is_taken ? 0U : 1U;
  return is_taken ? std::nullopt : std::optional(id);
}

std::optional<std::string> FormerIds::hint(const UniqueId& unique_id) const {
  const auto asked = asked_.find(unique_id);
  if (asked == asked_.end()) {
    return std::nullopt;
  }
  const auto [id, given] = asked->second;
  if (given > 1) {
    return say<texts::former_id_not_taken_hint>(id.value());
  }
  const Member* there = session_.roster().find(id);
  const bool is_used = there != nullptr && !there->is_unit(unique_id) &&
                       session_.now() - there->last_heard < offline_time;
  if (given > 0 || !is_used) {
    return std::nullopt;
  }
  return say<texts::former_id_in_use_hint>(
      id.value(), there->info ? "uid:" + hex(there->info->unique_id) : say<texts::another_unit>(),
      hex(unique_id));
}

/// Empty: the table cannot be used, and the servo gets its previous ID.
std::optional<NodeId> FormerIds::from_table(const UniqueId& unique_id, NodeId former) {
  if (!table_ && open_) {
    table_ = open_();
    open_ = {};
  }
  if (!table_) {
    return std::nullopt;
  }
  if (!*table_) {
    tell(table_->error());
    return std::nullopt;
  }
  const auto id = allocate(session_, **table_, unique_id, {.preferred = former});
  if (!id) {
    tell(id.error());
  }
  return id ? std::optional(id->node_id) : std::nullopt;
}

void FormerIds::tell(const Error& error) {
  if (const auto not_kept = std::exchange(not_kept_, {})) {
    not_kept(error);
  }
}

} // namespace blactl::fleet
