// An allocator that is not ours: an autopilot's.

#include "sim/scenario/foreign_role.hpp"

#include <algorithm>
#include <bitset>
#include <chrono>
#include <map>
#include <utility>

namespace blactl::sim {
namespace {

using namespace std::chrono_literals;

/// FOLLOWUP_TIMEOUT_MS (DSDL 1.Allocation).
constexpr Duration followup_timeout = 500ms;

constexpr std::uint8_t first_part_size =
    6; ///< in the first two parts; the third has the other four
constexpr std::uint8_t whole = 16;

/// Higher IDs are for tools (DSDL 1.Allocation); the search goes down from here.
constexpr std::uint8_t highest_given = 125;

/// Follows the standard to the letter, as the allocators of the common libraries do (DroneCAN
/// specification 6, "Dynamic node ID allocation"). It responds at once and ignores other
/// allocators: dronecan::Allocator, which waits for others and yields to them, would hide what
/// blactl must cope with. An ID under which any node was heard is not assigned to another unit.
class AllocationServer final : public ForeignRole {
 public:
  AllocationServer(dronecan::NodeId own_id, Broadcast broadcast)
      : ForeignRole(std::move(broadcast)) {
    in_use_.set(own_id.value());
  }

  [[nodiscard]] std::vector<std::uint16_t> subscriptions() const override {
    return {dronecan::Allocation::type.id};
  }

  void hear(const can::Frame& frame) override {
    if (const auto header = dronecan::decode_id(frame.id); header && frame.extended) {
      in_use_.set(header->source.value());
    }
  }

  void receive(const dronecan::Transfer& message) override;

 private:
  /// Returns 0 if the table is full.
  [[nodiscard]] std::uint8_t assign(const dronecan::UniqueId& unique_id);

  std::map<dronecan::UniqueId, std::uint8_t> given_;
  std::bitset<dronecan::NodeId::max + 1> in_use_;
  dronecan::Allocation collected_; ///< the parts of the unique ID accepted so far
  Time accepted_at_{};             ///< the time of the last of them
};

void AllocationServer::receive(const dronecan::Transfer& message) {
  const auto request = dronecan::Allocation::decode(message.payload);
  if (!request || message.header.source.is_unicast()) {
    return;
  }
  if (message.at - accepted_at_ > followup_timeout) {
    collected_ = {};
  }
  const std::uint8_t have = collected_.size;
  const auto expected = std::min<std::uint8_t>(first_part_size, whole - have);
  if (request->first_part_of_unique_id != (have == 0) || request->size != expected) {
    return;
  }
  std::copy_n(request->unique_id.begin(), expected, collected_.unique_id.begin() + have);
  collected_.size = static_cast<std::uint8_t>(have + expected);
  accepted_at_ = message.at;
  dronecan::Allocation reply = collected_;
  if (reply.size == whole) {
    collected_ = {};
    reply.node_id = assign(reply.unique_id);
    if (reply.node_id == 0) {
      return;
    }
  }
  broadcast(dronecan::Allocation::type, dronecan::priority_service, reply.encode().bytes());
}

std::uint8_t AllocationServer::assign(const dronecan::UniqueId& unique_id) {
  if (const auto known = given_.find(unique_id); known != given_.end()) {
    return known->second;
  }
  for (std::uint8_t id = highest_given; id > 0; --id) {
    if (!in_use_.test(id)) {
      in_use_.set(id);
      given_.emplace(unique_id, id);
      return id;
    }
  }
  return 0;
}

} // namespace

std::unique_ptr<ForeignRole> make_allocation_server(dronecan::NodeId own_id,
                                                    ForeignRole::Broadcast broadcast) {
  return std::make_unique<AllocationServer>(own_id, std::move(broadcast));
}

} // namespace blactl::sim
