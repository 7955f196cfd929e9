#pragma once
// A simulated bus with everything on it, as one state machine without I/O.

#include "blactl/sim/device.hpp"
#include "blactl/sim/medium.hpp"
#include "blactl/sim/scenario.hpp"

#include <chrono>
#include <memory>
#include <vector>

namespace blactl::sim {

/// Wall time at the beginning of the virtual clock: 2025-01-01 00:00 UTC.
inline constexpr WallTime virtual_epoch{std::chrono::sys_days(std::chrono::year(2025) / 1 / 1)};

/// The devices of a scenario, just powered on; each is yet to be connected.
[[nodiscard]] std::vector<std::unique_ptr<Device>> make_devices(const Scenario& scenario,
                                                                Time power_on);

/// The medium, the devices of a scenario, and the ports of clients. The same scenario and the same
/// calls give the same frames, to the microsecond.
class Simulator {
 public:
  /// The scenario's profiles must outlive this.
  Simulator(const Scenario& scenario, Time power_on);
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  [[nodiscard]] Time now() const { return now_; }

  /// When something happens next by itself; may be now().
  [[nodiscard]] Time next_event() const;

  /// Lets time pass, listeners hear what happens on the way. Never goes back.
  void advance_to(Time time);

  /// A client's node, at now(). See Medium.
  Medium::PortId attach(Medium::Listener& listener, std::size_t capacity);
  void detach(Medium::PortId port);
  bool send(Medium::PortId port, const can::Frame& frame);

  [[nodiscard]] const Medium& medium() const { return medium_; }

 private:
  class Station;

  Time now_;
  Medium medium_;
  std::vector<std::unique_ptr<Station>> stations_;
};

} // namespace blactl::sim
