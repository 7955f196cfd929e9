#pragma once
// A simulated bus of this process alone: `sim:SCENARIO.json`, or `sim:` while no simulator runs.

#include "blactl/can/bus.hpp"
#include "blactl/sim/bus/simulator.hpp"

#include <memory>
#include <optional>
#include <string>

namespace blactl::sim {

/// The servos power on when it is made, and are gone with it, unless they are given. On the
/// scenario's virtual clock time passes only in idle_until(), and then at once.
class PrivateBus final : public can::Bus {
 public:
  /// `name`: as given by the user. The scenario's profiles must outlive this.
  PrivateBus(std::string name, const Scenario& scenario);

  /// On a virtual clock, beside others that come later: the servos live on.
  PrivateBus(std::string name, std::shared_ptr<Simulator> simulator);
  ~PrivateBus() override;
  PrivateBus(const PrivateBus&) = delete;
  PrivateBus& operator=(const PrivateBus&) = delete;

  [[nodiscard]] std::string_view name() const override { return name_; }

  /// False while ten frames wait, the default queue of a CAN interface.
  [[nodiscard]] Result<bool> send(const can::Frame& frame) override;
  [[nodiscard]] std::optional<can::BusEvent> receive() override;
  [[nodiscard]] Result<void> filter(std::span<const can::Filter> filters) override;

  [[nodiscard]] bool echoes() const override { return true; }

  [[nodiscard]] std::string bus_off_hint() const override;

  [[nodiscard]] int descriptor() const override { return -1; }

  [[nodiscard]] Time now() const override;
  [[nodiscard]] WallTime wall() const override;
  [[nodiscard]] Time idle_until(Time deadline) override;

  /// For tests: the state of the servos.
  [[nodiscard]] const Simulator& simulator() const { return *simulator_; }

 private:
  class Inbox;

  std::string name_;
  Clock clock_;
  std::shared_ptr<Simulator> simulator_;
  std::unique_ptr<Inbox> inbox_;
  Medium::PortId port_;
};

} // namespace blactl::sim
