// A satellite receiver: a usual neighbour of servos on an aircraft's bus, and the one with the
// longest messages.

#include "blactl/sim/node/random.hpp"

#include "sim/scenario/foreign_role.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::sim {
namespace {

using namespace std::chrono_literals;

/// uavcan/equipment/gnss/1063.Fix2.uavcan, 1061.Auxiliary.uavcan
constexpr dronecan::DataType fix2{"uavcan.equipment.gnss.Fix2", 1063, false, 0xCA41E7000F37435F};
constexpr dronecan::DataType auxiliary{"uavcan.equipment.gnss.Auxiliary", 1061, false,
                                       0x9BE8BDC4C3DBBFD2};

/// The usual Fix2 of receivers: with the six diagonal elements of its covariance, and without a
/// position in ECEF. The length of the covariance is in the low six bits of one byte.
constexpr std::size_t fix2_size = 62;
constexpr std::size_t covariance_length_at = 47;
constexpr std::uint8_t covariance_length = 6;
constexpr std::uint8_t covariance_length_mask = 0x3F;

constexpr std::size_t auxiliary_size = 16;
constexpr Duration auxiliary_period = 1s;

constexpr dronecan::Priority fix_priority = dronecan::priority_medium;
constexpr dronecan::Priority auxiliary_priority = 24;

/// Sends Fix2 and, once a second, Auxiliary. Only sizes and rates are realistic; the contents are
/// meaningless.
class GnssReceiver final : public ForeignRole {
 public:
  GnssReceiver(const GnssSetup& setup, std::uint64_t seed, Broadcast broadcast, Time power_on)
      : ForeignRole(std::move(broadcast)), setup_(setup), random_(seed),
        next_fix_(power_on + setup.period), next_auxiliary_(power_on + auxiliary_period) {}

  [[nodiscard]] Time next_deadline() const override { return std::min(next_fix_, next_auxiliary_); }

  void advance(Time now) override;

 private:
  [[nodiscard]] std::vector<std::uint8_t> noise(std::size_t size);

  GnssSetup setup_;
  Random random_;
  Time next_fix_;
  Time next_auxiliary_;
};

void GnssReceiver::advance(Time now) {
  if (next_fix_ <= now) {
    next_fix_ += setup_.period;
    auto fix = noise(fix2_size);
    std::uint8_t& length = fix[covariance_length_at];
    length = static_cast<std::uint8_t>((length & ~covariance_length_mask) | covariance_length);
    broadcast(fix2, fix_priority, fix);
  }
  if (next_auxiliary_ <= now) {
    next_auxiliary_ += auxiliary_period;
    broadcast(auxiliary, auxiliary_priority, noise(auxiliary_size));
  }
}

std::vector<std::uint8_t> GnssReceiver::noise(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(random_.next());
  }
  return bytes;
}

} // namespace

std::unique_ptr<ForeignRole> make_gnss_receiver(const GnssSetup& setup, std::uint64_t seed,
                                                ForeignRole::Broadcast broadcast, Time power_on) {
  return std::make_unique<GnssReceiver>(setup, seed, std::move(broadcast), power_on);
}

} // namespace blactl::sim
