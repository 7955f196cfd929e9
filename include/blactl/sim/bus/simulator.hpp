#pragma once
// A simulated bus with everything on it, as one state machine without I/O.

#include "blactl/sim/bus/medium.hpp"
#include "blactl/sim/node/device.hpp"
#include "blactl/sim/scenario/scenario.hpp"
#include "blactl/sim/scenario/timeline.hpp"
#include "blactl/sim/servo/event.hpp"
#include "blactl/sim/servo/servo.hpp"

#include <chrono>
#include <memory>
#include <set>
#include <span>
#include <vector>

namespace blactl::sim {

/// Wall time at the beginning of the virtual clock: 2025-01-01 00:00 UTC.
inline constexpr WallTime virtual_epoch{std::chrono::sys_days(std::chrono::year(2025) / 1 / 1)};

struct Devices {
  std::vector<std::unique_ptr<Device>> all;
  std::vector<Servo*> servos; ///< the servos among the devices, in the order of the scenario

  /// Changes the surroundings of the servos with this serial number. False: there is none.
  bool change(std::int64_t serial_number, std::span<const WorldChange> changes, Time now) const;

  /// Applies an event to its servos.
  void happen(const TimedEvent& event, Time now) const;
};

/// The devices of a scenario, just powered on and not yet connected.
[[nodiscard]] Devices make_devices(const Scenario& scenario, Time power_on, const EventSink& sink);

/// The medium, the devices of a scenario, and the ports of clients. The same scenario and the same
/// calls give the same frames, to the microsecond.
class Simulator {
 public:
  /// The scenario's profiles must outlive this. `sink` receives the events of the servos.
  Simulator(const Scenario& scenario, Time power_on, const EventSink& sink = {});
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  [[nodiscard]] Time now() const { return now_; }

  /// The time of the next thing to happen by itself; may be now().
  [[nodiscard]] Time next_event() const;

  /// Lets time pass and calls the listeners on the way. Never goes back.
  void advance_to(Time time);

  /// A client's node, at now(). See Medium.
  Medium::PortId attach(Medium::Listener& listener, std::size_t capacity);
  void detach(Medium::PortId port);
  /// `at`: when it was handed over; where that is later than now(), the bus takes it then.
  bool send(Medium::PortId port, const can::Frame& frame, Time at = {});

  /// Applies to all clients, present and future.
  void link_clients(ClientLink link);

  bool change(std::int64_t serial_number, std::span<const WorldChange> changes) {
    return devices_.change(serial_number, changes, now_);
  }

  [[nodiscard]] const Medium& medium() const { return medium_; }

  /// In the order of the scenario.
  [[nodiscard]] const std::vector<Servo*>& servos() const { return devices_.servos; }

 private:
  class Station;

  void happen(const TimedEvent& event);

  Time now_;
  Medium medium_;
  Devices devices_;
  std::vector<std::unique_ptr<Station>> stations_; ///< of each of those devices
  std::set<Medium::PortId> clients_;
  ClientLink link_ = ClientLink::joined;
  Timeline timeline_;
};

} // namespace blactl::sim
