#pragma once
// The devices of a scenario on a real interface: `blactl sim -i vcan0`.

#include "blactl/can/loop.hpp"
#include "blactl/sim/bus/simulator.hpp"
#include "blactl/sim/node/device.hpp"
#include "blactl/sim/scenario/scenario.hpp"
#include "blactl/sim/scenario/timeline.hpp"
#include "blactl/sim/servo/event.hpp"

#include <cstddef>
#include <deque>

namespace blactl::sim {

/// All devices share the one node that this process is on the bus. The others receive a frame of
/// one device when it has been sent; no frame is received twice. The wire and the clients are real:
/// the wire faults of a scenario do not apply.
///
///   for (;;) { interface.handle(loop.next(interface.next_deadline())); }
class ServedInterface {
 public:
  /// Powers the devices on, on the clock of `loop`, whatever clock the scenario asks for. `loop`
  /// and the scenario's profiles must outlive this. `sink` receives the events of the servos.
  ServedInterface(can::Loop& loop, const Scenario& scenario, const EventSink& sink = {});

  [[nodiscard]] Time next_deadline() const;

  /// Passes a frame on, and does whatever is due in the devices.
  void handle(const can::Event& event);

  [[nodiscard]] const Devices& devices() const { return devices_; }

 private:
  struct Outgoing {
    can::Frame frame;
    std::size_t device;
  };

  void send(std::size_t device, const can::Frame& frame);
  void heard(const can::Frame& frame, Time at, std::size_t sender);

  can::Loop& loop_;
  Devices devices_;
  Timeline timeline_;
  std::deque<Outgoing> outgoing_; ///< not echoed yet
};

} // namespace blactl::sim
