#pragma once
// An allocator that is not ours: an autopilot's.

#include "sim/scenario/foreign_role.hpp"

#include <bitset>
#include <cstdint>
#include <map>

namespace blactl::sim {

/// Follows the standard to the letter, as the allocators of the common libraries do (DroneCAN
/// specification 6, "Dynamic node ID allocation"). It responds at once and ignores other
/// allocators: dronecan::Allocator, which waits for others and yields to them, would hide what
/// blactl must cope with. An ID under which any node was heard is not assigned to another unit.
class AllocationServer final : public ForeignRole {
 public:
  AllocationServer(dronecan::NodeId own_id, Broadcast broadcast);

  [[nodiscard]] std::vector<std::uint16_t> subscriptions() const override {
    return {dronecan::Allocation::type.id};
  }

  void hear(const can::Frame& frame) override;
  void receive(const dronecan::Transfer& message) override;

 private:
  /// Returns 0 if the table is full.
  [[nodiscard]] std::uint8_t assign(const dronecan::UniqueId& unique_id);

  std::map<dronecan::UniqueId, std::uint8_t> given_;
  std::bitset<dronecan::NodeId::max + 1> in_use_;
  dronecan::Allocation collected_; ///< the parts of the unique ID accepted so far
  Time accepted_at_{};             ///< the time of the last of them
};

} // namespace blactl::sim
