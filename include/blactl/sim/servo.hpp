#pragma once
// A simulated BLA servo (sections 2.2, 2.3 and chapters 3, 4).

#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/allocatee.hpp"
#include "blactl/sim/device.hpp"
#include "blactl/sim/endpoint.hpp"
#include "blactl/sim/random.hpp"
#include "blactl/sim/registers.hpp"
#include "blactl/sim/scenario.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace blactl::sim {

/// Answers GetNodeInfo and GetSet, sends NodeStatus and actuator.Status, asks for a node ID.
/// Not simulated: motion, ROM, restart; ExecuteOpcode, RestartNode and writes to 0x10-0x12 stay
/// without an answer.
class Servo final : public Device {
 public:
  /// `seed`: of its boot time and its allocation requests.
  Servo(const ServoSetup& setup, std::uint64_t seed, Time power_on);

  void receive(const can::Frame& frame, Time at) override;
  [[nodiscard]] Time next_deadline() const override;
  void advance(Time now) override;

  /// The address it uses on the bus; 0 while it has none.
  [[nodiscard]] dronecan::NodeId node_id() const { return endpoint_.node_id(); }

  [[nodiscard]] const Registers& registers() const { return registers_; }

 private:
  struct Answer {
    Time due;
    std::vector<can::Frame> frames;
  };

  void start(Time now);
  void operate(dronecan::NodeId id, Time now);
  void handle(const dronecan::Transfer& transfer);
  void hear_allocation(const dronecan::Transfer& transfer);
  void serve_node_info(const dronecan::Transfer& request);
  void serve_get_set(const dronecan::Transfer& request);
  [[nodiscard]] std::optional<bla::Address>
  addressed(const dronecan::GetSet::Request& request) const;
  void answer(const dronecan::Transfer& request, const dronecan::DataType& type,
              const dronecan::Payload& payload);
  void send_answers(Time now);
  void send_message(const dronecan::DataType& type, dronecan::Priority priority,
                    const dronecan::Payload& payload);
  [[nodiscard]] dronecan::NodeStatus node_status(Time now) const;
  [[nodiscard]] dronecan::ActuatorStatus actuator_status() const;

  ServoSetup setup_;
  Random random_;
  Registers registers_;
  Endpoint endpoint_;
  std::optional<Allocatee> allocatee_; ///< while it asks for a node ID
  bool running_ = false;
  Time started_; ///< when it begins to run; uptime counts from here
  Time now_;     ///< of the present receive() or advance()
  Time next_node_status_ = never;
  Time next_status_ = never;
  std::deque<Answer> answers_;
};

} // namespace blactl::sim
