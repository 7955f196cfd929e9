#pragma once
// Dynamic node ID allocation as far as heard: who asks for an ID, who gives them, and which.
// DroneCAN specification 6, uavcan/protocol/dynamic_node_id/1.Allocation.uavcan.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace blactl::fleet {

/// A unit without a node ID repeats its request after 0.6 s to 1 s (1.Allocation.uavcan); one may
/// be lost.
inline constexpr Duration request_period = std::chrono::seconds(2);

/// An unfinished allocation request: the part of the unique ID heard.
using UniqueIdPrefix = std::vector<std::uint8_t>;

/// The requests of one unit.
struct Asking {
  Time first{}, last{};
  Time given = Time::min(); ///< when this node gave it one; before all: it did not

  [[nodiscard]] bool is_repeated() const { return first != last; }
};

class AllocationWatch {
 public:
  /// A node ID that another allocator has given.
  struct Allotment {
    dronecan::UniqueId unit{};
    dronecan::NodeId by{};
    Time at{};
  };

  /// Takes every Allocation message of other nodes.
  void receive(const dronecan::Transfer& transfer);

  /// This node has given a node ID to this unit, as other allocators do.
  void give(const dronecan::UniqueId& unit, Time at);

  /// The units that have asked for a node ID and got none. A single request that is not repeated
  /// within 2 s does not count: a unit asks at least once a second.
  [[nodiscard]] std::vector<UniqueIdPrefix> pending() const;

  [[nodiscard]] const std::map<UniqueIdPrefix, Asking>& requests() const { return requests_; }

  /// The last request of a unit with this unique ID that has got none.
  [[nodiscard]] std::optional<Time> asked_at(const dronecan::UniqueId& unique_id) const;

  /// The other allocators.
  [[nodiscard]] std::set<dronecan::NodeId> allocators() const;

  /// The last one of this ID; empty: nobody else has given it.
  [[nodiscard]] std::optional<Allotment> allotment(dronecan::NodeId given) const;

  /// Forgets units that have not asked, and allocators that have been silent since then.
  void forget_silent(Time since);

 private:
  std::map<UniqueIdPrefix, Asking> requests_;
  std::map<dronecan::NodeId, Time> allocators_;      ///< when they last allocated
  std::map<dronecan::NodeId, Allotment> allotments_; ///< by the ID that was given
};

} // namespace blactl::fleet
