#pragma once
// A satellite receiver: a usual neighbour of servos on an aircraft's bus, and the one with the
// longest messages.

#include "blactl/sim/node/random.hpp"
#include "blactl/sim/scenario/foreign_setup.hpp"

#include "sim/scenario/foreign_role.hpp"

namespace blactl::sim {

/// Sends Fix2 and, once a second, Auxiliary. Only sizes and rates are realistic; the contents are
/// meaningless.
class GnssReceiver final : public ForeignRole {
 public:
  GnssReceiver(const GnssSetup& setup, std::uint64_t seed, Broadcast broadcast, Time power_on);

  [[nodiscard]] Time next_deadline() const override;
  void advance(Time now) override;

 private:
  [[nodiscard]] std::vector<std::uint8_t> noise(std::size_t size);

  GnssSetup setup_;
  Random random_;
  Time next_fix_;
  Time next_auxiliary_;
};

} // namespace blactl::sim
