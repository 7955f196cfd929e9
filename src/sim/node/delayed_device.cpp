#include "blactl/sim/node/delayed_device.hpp"

#include "blactl/dronecan/transfer.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::sim {
namespace {

constexpr Duration latest_double = std::chrono::milliseconds(20);
constexpr std::uint8_t last_frame_bit = 0x40; // of the tail byte

bool is_answer(const can::Frame& frame) {
  const auto header = dronecan::decode_id(frame.id);
  return header && header->kind == dronecan::Kind::response;
}

bool ends_transfer(const can::Frame& frame) {
  return frame.size == 0 || (frame.data[frame.size - std::size_t{1}] & last_frame_bit) != 0;
}

} // namespace

DelayedDevice::DelayedDevice(std::unique_ptr<Device> device, const SendingFaults& faults,
                             std::uint64_t seed)
    : device_(std::move(device)), faults_(faults), random_(seed) {
  device_->connect([this](const can::Frame& frame) { take(frame); });
}

void DelayedDevice::receive(const can::Frame& frame, Time at) {
  now_ = at;
  device_->receive(frame, at);
}

Time DelayedDevice::next_deadline() const {
  const Time own = waiting_.empty() ? never : waiting_.front().due;
  return std::min(own, device_->next_deadline());
}

void DelayedDevice::advance(Time now) {
  now_ = now;
  if (device_->next_deadline() <= now) {
    device_->advance(now);
  }
  while (!waiting_.empty() && waiting_.front().due <= now) {
    for (const can::Frame& frame : waiting_.front().transfer) {
      send(frame);
    }
    waiting_.pop_front();
  }
}

/// A device sends the frames of one transfer in a row.
void DelayedDevice::take(const can::Frame& frame) {
  incomplete_.push_back(frame);
  if (ends_transfer(frame)) {
    schedule(std::exchange(incomplete_, {}));
  }
}

void DelayedDevice::schedule(std::vector<can::Frame> transfer) {
  const bool answer = is_answer(transfer.front());
  if (answer && random_.chance(faults_.late_answers)) {
    return wait(now_ + faults_.late_by, std::move(transfer));
  }
  last_due_ = std::max(last_due_, now_ + random_.between(Duration::zero(), faults_.jitter));
  if (answer && random_.chance(faults_.double_answers)) {
    wait(last_due_ + random_.between(Duration::zero(), latest_double), transfer);
  }
  wait(last_due_, std::move(transfer));
}

void DelayedDevice::wait(Time due, std::vector<can::Frame> transfer) {
  const auto after = std::ranges::upper_bound(waiting_, due, {}, &Waiting::due);
  waiting_.insert(after, {due, std::move(transfer)});
}

} // namespace blactl::sim
