#pragma once
// The behaviour of a foreign node beyond that common to all nodes, and its kinds.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/scenario/foreign_setup.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace blactl::sim {

/// The default: nothing.
class ForeignRole {
 public:
  /// Sends a message from the node, and returns its frames.
  using Broadcast = std::function<std::vector<can::Frame>(
      const dronecan::DataType&, dronecan::Priority, dronecan::Bytes payload)>;

  explicit ForeignRole(Broadcast broadcast) : broadcast_(std::move(broadcast)) {}

  virtual ~ForeignRole() = default;
  ForeignRole(const ForeignRole&) = delete;
  ForeignRole& operator=(const ForeignRole&) = delete;

  /// The data type IDs of the messages passed to receive().
  [[nodiscard]] virtual std::vector<std::uint16_t> subscriptions() const { return {}; }

  /// Of NodeStatus and ArmingStatus.
  [[nodiscard]] virtual dronecan::Priority status_priority() const { return 20; }

  /// Handles any frame of another node.
  virtual void hear(const can::Frame& /*frame*/) {}

  virtual void receive(const dronecan::Transfer& /*message*/) {}

  /// The response has no value and no name if there is no such parameter (DSDL 11.GetSet).
  [[nodiscard]] virtual dronecan::GetSet::Response
  get_set(const dronecan::GetSet::Request& /*request*/) {
    return {};
  }

  /// The latest time for the next advance().
  [[nodiscard]] virtual Time next_deadline() const { return never; }

  virtual void advance(Time /*now*/) {}

 protected:
  std::vector<can::Frame> broadcast(const dronecan::DataType& type, dronecan::Priority priority,
                                    dronecan::Bytes payload) const {
    return broadcast_(type, priority, payload);
  }

 private:
  Broadcast broadcast_;
};

// The kinds, each in a source of its own.
[[nodiscard]] std::unique_ptr<ForeignRole> make_gnss_receiver(const GnssSetup& setup,
                                                              std::uint64_t seed,
                                                              ForeignRole::Broadcast broadcast,
                                                              Time power_on);
[[nodiscard]] std::unique_ptr<ForeignRole>
make_esc(const EscSetup& setup, ForeignRole::Broadcast broadcast, Time power_on);
[[nodiscard]] std::unique_ptr<ForeignRole>
make_babbler(const BabblerSetup& setup, ForeignRole::Broadcast broadcast, Time power_on);
[[nodiscard]] std::unique_ptr<ForeignRole> make_allocation_server(dronecan::NodeId own_id,
                                                                  ForeignRole::Broadcast broadcast);

} // namespace blactl::sim
