#pragma once
// The DroneCAN side of a simulated node: its ID, its transfer IDs, the reassembly of transfers for
// it.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace blactl::sim {

class Endpoint {
 public:
  using Handler = std::function<void(const dronecan::Transfer&)>;

  /// `handler` receives complete messages of the `subscriptions` (data type IDs) and the requests
  /// to this node's ID. A repeated transfer ID within 2 s is dropped, as the standard requires.
  Endpoint(std::vector<std::uint16_t> subscriptions, Handler handler);

  [[nodiscard]] dronecan::NodeId node_id() const { return node_id_; }

  void set_node_id(dronecan::NodeId id) { node_id_ = id; }

  /// Resets to the state after power-on: no ID, transfer IDs from 0, nothing half received.
  void restart();

  void receive(const can::Frame& frame, Time at);

  /// The frames of a message from this node; anonymous while it has no ID.
  [[nodiscard]] std::vector<can::Frame> message(const dronecan::DataType& type,
                                                dronecan::Priority priority,
                                                std::span<const std::uint8_t> payload);

  /// The frames of a request of this node.
  [[nodiscard]] std::vector<can::Frame> request(dronecan::NodeId server,
                                                const dronecan::DataType& type,
                                                std::span<const std::uint8_t> payload);

  /// The frames of the response to `request`, at the priority of the request.
  [[nodiscard]] std::vector<can::Frame> response(const dronecan::Transfer& request,
                                                 const dronecan::DataType& type,
                                                 std::span<const std::uint8_t> payload) const;

 private:
  [[nodiscard]] dronecan::TransferId next_id(std::uint16_t data_type_id);
  [[nodiscard]] bool wants(const dronecan::Header& header) const;

  std::vector<std::uint16_t> subscriptions_;
  Handler handler_;
  dronecan::NodeId node_id_;
  std::map<std::uint16_t, dronecan::TransferId> next_transfer_id_;
  std::optional<dronecan::Receiver> receiver_; ///< never empty
};

} // namespace blactl::sim
