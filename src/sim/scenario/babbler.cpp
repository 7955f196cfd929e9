#include "sim/scenario/babbler.hpp"

#include "blactl/can/frame_bits.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace blactl::sim {
namespace {

/// uavcan/protocol/debug/16370.KeyValue.uavcan
constexpr dronecan::DataType key_value{"uavcan.protocol.debug.KeyValue", 16370, false,
                                       0xE02F25D6E0C98AE0};

} // namespace

Babbler::Babbler(const BabblerSetup& setup, Broadcast broadcast, Time power_on)
    : ForeignRole(std::move(broadcast)), setup_(setup), power_on_(power_on) {}

/// A bit takes 1 us: at a load of 1 the next frame begins with the end of this one.
Time Babbler::next_deadline() const {
  if (setup_.load <= 0) {
    return never;
  }
  return power_on_ + Duration(static_cast<Duration::rep>(std::ceil(bits_ / setup_.load)));
}

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

} // namespace blactl::sim
