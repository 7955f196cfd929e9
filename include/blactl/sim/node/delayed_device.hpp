#pragma once
// A device whose frames do not leave when they should.

#include "blactl/sim/node/device.hpp"
#include "blactl/sim/node/random.hpp"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace blactl::sim {

/// When the frames of a device leave. Probabilities, from 0 to 1, are of one answer.
struct SendingFaults {
  Duration jitter{};         ///< every transfer leaves up to so much later, in the order of sending
  double late_answers = 0;   ///< an answer leaves `late_by` later, whatever was sent meanwhile
  Duration late_by{};        ///< best beyond the patience of who has asked
  double double_answers = 0; ///< an answer leaves twice, the second time up to 20 ms later

  [[nodiscard]] bool any() const {
    return jitter > Duration::zero() || late_answers > 0 || double_answers > 0;
  }
};

/// Stands for the device on the bus. Answers are the transfers of services that are no requests.
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
  Time last_due_{};                    ///< of what keeps its order
  std::vector<can::Frame> incomplete_; ///< the transfer that the device is sending
  std::deque<Waiting> waiting_;        ///< in the order of leaving
};

} // namespace blactl::sim
