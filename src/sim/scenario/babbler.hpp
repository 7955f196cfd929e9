#pragma once
// A node that floods the bus, as a faulty one does.

#include "blactl/sim/scenario/foreign_setup.hpp"

#include "sim/scenario/foreign_role.hpp"

namespace blactl::sim {

/// Fills a part of the bus with single frames of KeyValue.
class Babbler final : public ForeignRole {
 public:
  Babbler(const BabblerSetup& setup, Broadcast broadcast, Time power_on);

  /// A higher priority, so that its NodeStatus does not wait behind others' frames and hold up the
  /// stream.
  [[nodiscard]] dronecan::Priority status_priority() const override { return setup_.priority; }

  [[nodiscard]] Time next_deadline() const override;
  void advance(Time now) override;

 private:
  BabblerSetup setup_;
  Time power_on_;
  double bits_ = 0; ///< sent so far, including the pauses between frames
  std::uint8_t counter_ = 0;
};

} // namespace blactl::sim
