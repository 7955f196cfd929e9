#pragma once
// The allocator's side of dynamic node ID allocation.
// DroneCAN specification 6, uavcan/protocol/dynamic_node_id/1.Allocation.uavcan; Futaba 2.3,
// tables 2-7 and 2-8.

#include "blactl/dronecan/node.hpp"
#include "blactl/dronecan/service.hpp"

#include <optional>

namespace blactl::dronecan {

/// Assigns node IDs to units.
class AllocationTable {
 public:
  virtual ~AllocationTable() = default;
  AllocationTable(const AllocationTable&) = delete;
  AllocationTable& operator=(const AllocationTable&) = delete;

  /// Whether a unit whose unique ID begins with these bytes may get an ID from this table.
  [[nodiscard]] virtual bool serves(Bytes prefix) const = 0;

  /// The ID of this unit; empty: it gets none now. Our own ID is never given. `preferred`: the ID
  /// that the unit asked for; 0: any.
  [[nodiscard]] virtual std::optional<NodeId> assign(const UniqueId& unique_id,
                                                     NodeId preferred) = 0;

 protected:
  AllocationTable() = default;
};

/// Answers the three parts of an allocation request. Once another allocator is heard, this one
/// stays silent for good; before its first answer it waits 100 ms for one. A unit without a unique
/// ID of its own gets none.
class Allocator final : public Service {
 public:
  /// Both arguments outlive the allocator.
  Allocator(Node& node, AllocationTable& table) : node_(node), table_(table) {}

  void receive(const Transfer& transfer) override;

  [[nodiscard]] Time next_deadline() const override { return answer_due_; }

  void advance(Time now) override;

  /// The other allocator that was heard, if any.
  [[nodiscard]] std::optional<NodeId> other() const { return other_; }

 private:
  [[nodiscard]] bool takes(const Allocation& request);
  void answer();

  Node& node_;
  AllocationTable& table_;
  Allocation collected_; ///< the parts of the unique ID heard so far
  NodeId preferred_{};   ///< from the last part
  Time answered_at_{};   ///< the last accepted part: when its answer was or is due
  Time answer_due_ = never;
  bool has_answered_ = false;
  std::optional<NodeId> other_;
};

} // namespace blactl::dronecan
