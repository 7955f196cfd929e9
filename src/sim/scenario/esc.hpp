#pragma once
// An electronic speed controller: a node with other parameters than a servo.

#include "blactl/sim/scenario/foreign_setup.hpp"

#include "sim/scenario/foreign_role.hpp"

#include <vector>

namespace blactl::sim {

/// Sends esc.Status, and has parameters of every kind in GetSet, by name and by index from 0. A
/// value of another kind or out of range leaves the parameter unchanged; nothing is saved to ROM.
class Esc final : public ForeignRole {
 public:
  Esc(const EscSetup& setup, Broadcast broadcast, Time power_on);

  [[nodiscard]] dronecan::GetSet::Response
  get_set(const dronecan::GetSet::Request& request) override;

  [[nodiscard]] Time next_deadline() const override { return next_status_; }

  void advance(Time now) override;

 private:
  EscSetup setup_;
  std::vector<dronecan::GetSet::Response> parameters_; ///< each as the response to a read
  Time next_status_;
};

} // namespace blactl::sim
