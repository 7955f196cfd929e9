#pragma once
// What goes wrong on a simulated wire, by chance that repeats.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/sim/node/random.hpp"

#include <cstdint>
#include <map>

namespace blactl::sim {

/// How often. Probabilities, from 0 to 1, are of one frame.
struct WireFaults {
  double loss = 0;        ///< a receiver misses a frame; each for itself
  double duplication = 0; ///< the sender alone sees an error at the very end, and repeats the frame
  double errors = 0;      ///< all see an error; the sender repeats the frame
  double bit_flips = 0; ///< of a transfer of several frames, at most three bits are received wrong
  Duration burst_interval{}; ///< mean time between bursts of errors; zero: there are none
  Duration burst_length{};   ///< in which every frame is destroyed

  friend bool operator==(const WireFaults&, const WireFaults&) = default;
};

/// Decides for each frame what happens to it. The same seed and the same calls: the same faults.
class WireDisturbance {
 public:
  WireDisturbance(const WireFaults& faults, std::uint64_t seed) : faults_(faults), random_(seed) {}

  /// Whether an error destroys the frame that begins now. Time never goes back.
  [[nodiscard]] bool destroys(Time now);

  /// Whether the sender has to repeat the frame that all others have received.
  [[nodiscard]] bool duplicates() { return random_.chance(faults_.duplication); }

  /// Whether one receiver misses the frame.
  [[nodiscard]] bool loses() { return random_.chance(faults_.loss); }

  /// The frame as everybody receives it. Only data of transfers of several frames is changed: their
  /// CRC finds up to three wrong bits, nothing protects single frames but the CRC of CAN.
  [[nodiscard]] can::Frame received(const can::Frame& sent);

 private:
  WireFaults faults_;
  Random random_;
  Time burst_begin_{}, burst_end_{};
  std::map<std::uint32_t, unsigned> flipped_; ///< bits of the present transfer, by CAN ID
};

} // namespace blactl::sim
