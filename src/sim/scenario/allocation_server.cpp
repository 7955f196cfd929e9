#include "sim/scenario/allocation_server.hpp"

#include <algorithm>
#include <chrono>
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

} // namespace

AllocationServer::AllocationServer(dronecan::NodeId own_id, Broadcast broadcast)
    : ForeignRole(std::move(broadcast)) {
  in_use_.set(own_id.value());
}

void AllocationServer::hear(const can::Frame& frame) {
  if (const auto header = dronecan::decode_id(frame.id); header && frame.extended) {
    in_use_.set(header->source.value());
  }
}

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

} // namespace blactl::sim
