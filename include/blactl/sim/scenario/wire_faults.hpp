#pragma once
// Faults of a simulated wire, at random but reproducible.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/sim/node/random.hpp"

#include <cstdint>
#include <map>

namespace blactl::sim {

/// The frequency of the faults. Probabilities, from 0 to 1, are per frame.
struct WireFaults {
  double loss = 0;        ///< a receiver misses a frame; each receiver independently
  double duplication = 0; ///< only the sender sees an error, at the very end, and repeats the frame
  double errors = 0;      ///< all nodes see an error; the sender repeats the frame
  double bit_flips = 0;   ///< in a multi-frame transfer, up to three bits are received wrong
  Duration burst_interval{}; ///< mean time between bursts of errors; zero: no bursts
  Duration burst_length{};   ///< every frame of a burst is destroyed

  friend bool operator==(const WireFaults&, const WireFaults&) = default;
};

/// Decides on the faults of each frame. The same seed and the same calls give the same faults.
class WireDisturbance {
 public:
  WireDisturbance(const WireFaults& faults, std::uint64_t seed) : faults_(faults), random_(seed) {}

  /// Whether an error destroys the frame that begins now. Time never goes back.
  [[nodiscard]] bool destroys(Time now);

  /// Whether the sender repeats the frame that all others have received.
  [[nodiscard]] bool duplicates() { return random_.chance(faults_.duplication); }

  /// Whether one receiver misses the frame.
  [[nodiscard]] bool loses() { return random_.chance(faults_.loss); }

  /// The frame as received by all nodes. Only multi-frame transfers are changed: their CRC detects
  /// up to three wrong bits, whereas single frames have only the CRC of CAN.
  [[nodiscard]] can::Frame received(const can::Frame& sent);

 private:
  WireFaults faults_;
  Random random_;
  Time burst_begin_{}, burst_end_{};
  std::map<std::uint32_t, unsigned> flipped_; ///< flipped bits of the present transfer, by CAN ID
};

} // namespace blactl::sim
