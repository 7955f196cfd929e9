#include "blactl/sim/scenario/wire_faults.hpp"

#include <cstddef>

namespace blactl::sim {
namespace {

constexpr unsigned most_flips = 3;

// Of the tail byte (DroneCAN specification, transport layer).
constexpr std::uint8_t start_of_transfer = 0x80;
constexpr std::uint8_t end_of_transfer = 0x40;

} // namespace

bool WireDisturbance::destroys(Time now) {
  if (faults_.burst_interval > Duration::zero()) {
    while (burst_end_ <= now) {
      burst_begin_ = burst_end_ + random_.between(Duration::zero(), 2 * faults_.burst_interval);
      burst_end_ = burst_begin_ + faults_.burst_length + Duration(1);
    }
    if (burst_begin_ <= now) {
      return true;
    }
  }
  return random_.chance(faults_.errors);
}

can::Frame WireDisturbance::received(const can::Frame& sent) {
  can::Frame frame = sent;
  if (faults_.bit_flips <= 0 || frame.size < 2) {
    return frame;
  }
  const std::size_t data_size = frame.size - std::size_t{1};
  const std::uint8_t tail = frame.data[data_size];
  if ((tail & start_of_transfer) != 0) {
    flipped_.erase(frame.id);
    if ((tail & end_of_transfer) != 0) {
      return frame;
    }
  }
  unsigned& flipped = flipped_[frame.id];
  while (flipped < most_flips && random_.chance(faults_.bit_flips)) {
    const std::uint64_t bit = random_.next() % (8 * data_size);
    frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    ++flipped;
  }
  if ((tail & end_of_transfer) != 0) {
    flipped_.erase(frame.id);
  }
  return frame;
}

} // namespace blactl::sim
