#pragma once
// An allocator that is not ours: that of an autopilot.

#include "sim/scenario/foreign_role.hpp"

#include <bitset>
#include <cstdint>
#include <map>

namespace blactl::sim {

/// Follows the standard to the letter, as the allocators of the common libraries do
/// (DroneCAN specification 6, "Dynamic node ID allocation"). It answers at once and takes no notice
/// of other allocators: dronecan::Allocator, which waits for others and gives way to them, would
/// hide what blactl must stand. An ID under which anybody was heard is not given to another unit.
class AllocationServer final : public ForeignRole {
 public:
  AllocationServer(dronecan::NodeId own_id, Broadcast broadcast);

  [[nodiscard]] std::vector<std::uint16_t> subscriptions() const override {
    return {dronecan::Allocation::type.id};
  }

  void hear(const can::Frame& frame) override;
  void receive(const dronecan::Transfer& message) override;

 private:
  /// 0: the table is full.
  [[nodiscard]] std::uint8_t assign(const dronecan::UniqueId& unique_id);

  std::map<dronecan::UniqueId, std::uint8_t> given_;
  std::bitset<dronecan::NodeId::max + 1> in_use_;
  dronecan::Allocation collected_; ///< the parts of the unique ID that were accepted
  Time accepted_at_{};             ///< the last of them
};

} // namespace blactl::sim
