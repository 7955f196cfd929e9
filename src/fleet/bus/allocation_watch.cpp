#include "blactl/fleet/bus/allocation_watch.hpp"

#include "blactl/dronecan/types.hpp"

#include <algorithm>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// Bound for the memory that other nodes can make us use.
constexpr std::size_t most_requests = 1024;

} // namespace

void AllocationWatch::receive(const dronecan::Transfer& transfer) {
  const auto allocation = dronecan::Allocation::decode(transfer.payload);
  if (!allocation) {
    return;
  }
  const UniqueIdPrefix prefix(allocation->unique_id.begin(),
                              allocation->unique_id.begin() + allocation->size);
  if (transfer.header.source.is_unicast()) {
    allocators_.insert_or_assign(transfer.header.source, transfer.at);
    if (allocation->node_id != 0 && prefix.size() == allocation->unique_id.size()) {
      allotments_[NodeId(allocation->node_id)] = {allocation->unique_id, transfer.header.source,
                                                  transfer.at};
      std::erase_if(requests_, [&](const auto& waiting) {
        return dronecan::begins_with(allocation->unique_id, waiting.first);
      });
    }
  } else if (allocation->first_part_of_unique_id && !prefix.empty()) {
    std::erase_if(requests_, [&](const auto& entry) {
      return !entry.second.is_repeated() && transfer.at - entry.second.last > request_period;
    });
    if (requests_.size() < most_requests || requests_.contains(prefix)) {
      requests_.try_emplace(prefix, Asking{transfer.at, transfer.at}).first->second.last =
          transfer.at;
    }
  }
}

void AllocationWatch::give(const dronecan::UniqueId& unit, Time at) {
  for (auto& [prefix, asking] : requests_) {
    if (dronecan::begins_with(unit, prefix)) {
      asking.given = at;
    }
  }
}

std::vector<UniqueIdPrefix> AllocationWatch::pending() const {
  std::vector<UniqueIdPrefix> waiting;
  for (const auto& [prefix, asking] : requests_) {
    if (asking.last > asking.given) {
      waiting.push_back(prefix);
    }
  }
  return waiting;
}

std::optional<Time> AllocationWatch::asked_at(const dronecan::UniqueId& unique_id) const {
  const auto waiting = std::ranges::find_if(requests_, [&](const auto& entry) {
    return entry.second.last > entry.second.given && dronecan::begins_with(unique_id, entry.first);
  });
  return waiting != requests_.end() ? std::optional(waiting->second.last) : std::nullopt;
}

std::set<NodeId> AllocationWatch::allocators() const {
  std::set<NodeId> ids;
  for (const auto& [id, last] : allocators_) {
    ids.insert(id);
  }
  return ids;
}

std::optional<AllocationWatch::Allotment> AllocationWatch::allotment(NodeId given) const {
  const auto allotted = allotments_.find(given);
  return allotted != allotments_.end() ? std::optional(allotted->second) : std::nullopt;
}

void AllocationWatch::forget_silent(Time since) {
  std::erase_if(requests_, [&](const auto& asking) { return asking.second.last < since; });
  std::erase_if(allocators_, [&](const auto& allocator) { return allocator.second < since; });
}

} // namespace blactl::fleet
