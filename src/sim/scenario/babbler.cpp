// A node that floods the bus, as a faulty one does.

#include "blactl/can/frame_bits.hpp"

#include "sim/scenario/foreign_role.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace blactl::sim {
namespace {

/// uavcan/protocol/debug/16370.KeyValue.uavcan
constexpr dronecan::DataType key_value{"uavcan.protocol.debug.KeyValue", 16370, false,
                                       0xE02F25D6E0C98AE0};

/// Fills a part of the bus with single frames of KeyValue.
class Babbler final : public ForeignRole {
 public:
  Babbler(const BabblerSetup& setup, Broadcast broadcast, Time power_on)
      : ForeignRole(std::move(broadcast)), setup_(setup), power_on_(power_on) {}

  /// A higher priority, so that its NodeStatus does not wait behind others' frames and hold up the
  /// stream.
  [[nodiscard]] dronecan::Priority status_priority() const override { return setup_.priority; }

  /// A bit takes 1 us: at a load of 1 the next frame begins with the end of this one.
  [[nodiscard]] Time next_deadline() const override {
    return setup_.load <= 0
               ? never
               : power_on_ + Duration(static_cast<Duration::rep>(std::ceil(bits_ / setup_.load)));
  }

  void advance(Time now) override;

 private:
  BabblerSetup setup_;
  Time power_on_;
  double bits_ = 0; ///< sent so far, including the pauses between frames
  std::uint8_t counter_ = 0;
};

void Babbler::advance(Time now) {
  if (next_deadline() > now) {
    return;
  }
  // a float32 that changes, and a name of three letters
  const std::array<std::uint8_t, 7> payload{counter_++, 0, 0x80, 0x3F, 'b', 'l', 'a'};
  for (const can::Frame& frame : broadcast(key_value, setup_.priority, payload)) {
    bits_ += static_cast<double>(can::frame_length(frame) + can::intermission_bits);
  }
}

} // namespace

std::unique_ptr<ForeignRole> make_babbler(const BabblerSetup& setup,
                                          ForeignRole::Broadcast broadcast, Time power_on) {
  return std::make_unique<Babbler>(setup, std::move(broadcast), power_on);
}

} // namespace blactl::sim
