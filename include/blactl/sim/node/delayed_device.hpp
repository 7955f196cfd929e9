#pragma once
// A device whose frames leave late or twice.

#include "blactl/sim/node/device.hpp"
#include "blactl/sim/node/random.hpp"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace blactl::sim {

/// Faults of a device's sending. Probabilities, from 0 to 1, are per response.
struct SendingFaults {
  Duration jitter{};         ///< every transfer is delayed by up to this, in the order of sending
  double late_answers = 0;   ///< a response is delayed by `late_by`, and may be overtaken
  Duration late_by{};        ///< best longer than the client's timeout
  double double_answers = 0; ///< a response is sent twice, the second time up to 20 ms later

  [[nodiscard]] bool any() const {
    return jitter > Duration::zero() || late_answers > 0 || double_answers > 0;
  }
};

/// Replaces the device on the bus.
class DelayedDevice final : public Device {
 public:
  DelayedDevice(std::unique_ptr<Device> device, const SendingFaults& faults, std::uint64_t seed);

  void receive(const can::Frame& frame, Time at) override;
  [[nodiscard]] Time next_deadline() const override;
  void advance(Time now) override;

 private:
  struct Waiting {
    Time due;
    std::vector<can::Frame> transfer;
  };

  void take(const can::Frame& frame);
  void schedule(std::vector<can::Frame> transfer);
  void wait(Time due, std::vector<can::Frame> transfer);

  std::unique_ptr<Device> device_;
  SendingFaults faults_;
  Random random_;
  Time now_{};
  Time last_due_{};                    ///< of the transfers that keep their order
  std::vector<can::Frame> incomplete_; ///< the transfer being sent by the device
  std::deque<Waiting> waiting_;        ///< in the order of departure
};

} // namespace blactl::sim
