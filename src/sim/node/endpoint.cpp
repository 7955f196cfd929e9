#include "blactl/sim/node/endpoint.hpp"

#include "blactl/dronecan/types.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace blactl::sim {
namespace {

/// Concurrent sessions of the reassembly.
constexpr std::size_t sessions = 32;

std::optional<std::uint64_t> signature_of(dronecan::Kind kind, std::uint16_t data_type_id) {
  const dronecan::DataType* type = dronecan::find_type(kind, data_type_id);
  return type != nullptr ? std::optional(type->signature) : std::nullopt;
}

} // namespace

Endpoint::Endpoint(std::vector<std::uint16_t> subscriptions, Handler handler)
    : subscriptions_(std::move(subscriptions)), handler_(std::move(handler)) {
  restart();
}

// The receiver accepts frames to every node ID (0); wants() selects those for this node, as its ID
// is not known at first.
void Endpoint::restart() {
  node_id_ = {};
  next_transfer_id_.clear();
  receiver_.emplace(sessions, dronecan::anonymous,
                    dronecan::Receiver::Callbacks{handler_, {}, signature_of});
}

bool Endpoint::wants(const dronecan::Header& header) const {
  if (header.kind == dronecan::Kind::message) {
    return std::ranges::find(subscriptions_, header.data_type_id) != subscriptions_.end();
  }
  return header.kind == dronecan::Kind::request && header.destination == node_id_;
}

void Endpoint::receive(const can::Frame& frame, Time at) {
  if (!frame.extended || frame.remote) {
    return;
  }
  const auto header = dronecan::decode_id(frame.id);
  if (header && wants(*header)) {
    receiver_->receive(frame, at);
  }
}

std::vector<can::Frame> Endpoint::message(const dronecan::DataType& type,
                                          dronecan::Priority priority,
                                          std::span<const std::uint8_t> payload) {
  const dronecan::TransferId id = next_id(type.id);
  dronecan::Header header{dronecan::Kind::message, priority, type.id, node_id_, {}, 0};
  if (!node_id_.is_unicast()) {
    header.discriminator = dronecan::discriminator(payload, id);
  }
  return dronecan::segment(header, id, type.signature, payload);
}

dronecan::TransferId Endpoint::next_id(std::uint16_t data_type_id) {
  dronecan::TransferId& next = next_transfer_id_[data_type_id];
  return std::exchange(
      next, static_cast<dronecan::TransferId>((next + 1) % dronecan::transfer_id_modulus));
}

std::vector<can::Frame> Endpoint::request(dronecan::NodeId server, const dronecan::DataType& type,
                                          std::span<const std::uint8_t> payload) {
  const dronecan::Header header{
      dronecan::Kind::request, dronecan::priority_medium, type.id, node_id_, server, 0};
  return dronecan::segment(header, next_id(type.id), type.signature, payload);
}

std::vector<can::Frame> Endpoint::response(const dronecan::Transfer& request,
                                           const dronecan::DataType& type,
                                           std::span<const std::uint8_t> payload) const {
  const dronecan::Header header{dronecan::Kind::response,
                                request.header.priority,
                                type.id,
                                node_id_,
                                request.header.source,
                                0};
  return dronecan::segment(header, request.transfer_id, type.signature, payload);
}

} // namespace blactl::sim
