#pragma once
// A node on the simulated bus that is not a BLA servo: an autopilot, a satellite receiver.

#include "blactl/bla/address.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/node/device.hpp"
#include "blactl/sim/node/endpoint.hpp"
#include "blactl/sim/scenario/foreign_setup.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace blactl::sim {

class ForeignRole;

/// Sends NodeStatus and answers GetNodeInfo; if configured, it answers GetSet, orders, streams
/// ArrayCommand, and sends ArmingStatus and actuator.Status. Its role adds the behaviour of its
/// kind.
class ForeignNode final : public Device {
 public:
  /// Silent and deaf before `power_on`.
  ForeignNode(const ForeignSetup& setup, Time power_on);
  ~ForeignNode() override;

  void receive(const can::Frame& frame, Time at) override;
  [[nodiscard]] Time next_deadline() const override;
  void advance(Time now) override;

 private:
  [[nodiscard]] std::unique_ptr<ForeignRole> make_role(Time power_on);
  [[nodiscard]] Time next_order() const;
  void send_arming();
  void send_order(const OrderSetup& order);
  [[nodiscard]] std::vector<can::Frame> write(dronecan::NodeId server, bla::Address address,
                                              std::int64_t value);
  void handle(const dronecan::Transfer& transfer);
  void answer(const dronecan::Transfer& request, const dronecan::DataType& type,
              const dronecan::Payload& payload);
  std::vector<can::Frame> send_message(const dronecan::DataType& type, dronecan::Priority priority,
                                       dronecan::Bytes payload);
  [[nodiscard]] dronecan::NodeStatus node_status() const;

  ForeignSetup setup_;
  std::unique_ptr<ForeignRole> role_; ///< never null
  Endpoint endpoint_;
  Time power_on_;
  Time now_;
  Time next_status_;
  Time arms_ = never; ///< tells so at once
  Time next_command_ = never;
  Time next_actuator_ = never;
  std::size_t orders_sent_ = 0;
};

} // namespace blactl::sim
