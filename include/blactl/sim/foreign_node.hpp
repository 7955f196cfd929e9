#pragma once
// A node on the simulated bus that is no BLA servo: an autopilot, a GNSS receiver.

#include "blactl/dronecan/types.hpp"
#include "blactl/sim/device.hpp"
#include "blactl/sim/endpoint.hpp"
#include "blactl/sim/scenario.hpp"

namespace blactl::sim {

/// Sends NodeStatus and answers GetNodeInfo; if the setup says so it answers GetSet like a node
/// without parameters, streams ArrayCommand, and sends ArmingStatus.
class ForeignNode final : public Device {
 public:
  ForeignNode(const ForeignSetup& setup, Time power_on);

  void receive(const can::Frame& frame, Time at) override;
  [[nodiscard]] Time next_deadline() const override;
  void advance(Time now) override;

 private:
  void handle(const dronecan::Transfer& request);
  void answer(const dronecan::Transfer& request, const dronecan::DataType& type,
              const dronecan::Payload& payload);
  void send_message(const dronecan::DataType& type, dronecan::Priority priority,
                    const dronecan::Payload& payload);
  [[nodiscard]] dronecan::NodeStatus node_status() const;

  ForeignSetup setup_;
  Endpoint endpoint_;
  Time power_on_;
  Time now_;
  Time next_status_;
  Time next_command_ = never;
};

} // namespace blactl::sim
