#include "buses.hpp"

#include <chrono>
#include <variant>

namespace blactl::campaign {
namespace {

using Kind = Disturbance::Kind;

constexpr Duration lateness = std::chrono::milliseconds(300);
constexpr std::uint32_t other_node = 99;

/// Nobody can tell a flipped bit in a transfer of one frame, which has no CRC of its own; that of
/// CAN destroys such a frame.
bool has_crc(const can::Frame& frame) {
  constexpr std::uint8_t both_ends = 0xC0;
  return frame.size > 1 && (frame.data[frame.size - 1U] & both_ends) != both_ends;
}

} // namespace

std::optional<can::BusEvent> Witness::receive() {
  auto event = BusAround::receive();
  if (event) {
    if (const auto* received = std::get_if<can::Received>(&*event)) {
      record_.add(received->frame, received->at);
    } else if (const auto* sent = std::get_if<can::Sent>(&*event)) {
      record_.add(sent->frame, sent->at);
    }
  }
  return event;
}

Result<bool> DisturbedBus::send(const can::Frame& frame) {
  if (disturbance_.kind == Kind::computer_off && disturbance_.has_struck()) {
    throw Killed();
  }
  const bool is_about_sent =
      disturbance_.kind == Kind::request_lost || disturbance_.kind == Kind::killed;
  if (!is_about_sent || !disturbance_.strikes()) {
    return BusAround::send(frame);
  }
  if (disturbance_.kind == Kind::killed) {
    throw Killed();
  }
  next_.emplace_back(can::Sent{frame, now(), wall()}); // a node acknowledged it, and lost it
  return true;
}

std::optional<can::BusEvent> DisturbedBus::receive() {
  if (!withheld_.empty() && withheld_.front().at + lateness <= now()) {
    next_.emplace_back(withheld_.front());
    withheld_.pop_front();
  }
  if (!next_.empty()) {
    auto event = std::move(next_.front());
    next_.pop_front();
    return event;
  }
  auto event = BusAround::receive();
  const auto* received = event ? std::get_if<can::Received>(&*event) : nullptr;
  return received != nullptr ? disturbed(*received) : event;
}

std::optional<can::BusEvent> DisturbedBus::disturbed(can::Received received) {
  const bool is_about_received =
      disturbance_.kind >= Kind::frame_lost && disturbance_.kind <= Kind::frame_of_other;
  const bool is_meant = disturbance_.kind != Kind::frame_corrupted || has_crc(received.frame);
  if (!is_about_received || !is_meant || !disturbance_.strikes()) {
    return received;
  }
  switch (disturbance_.kind) {
  case Kind::frame_lost: return receive();
  case Kind::frame_doubled: next_.emplace_back(received); break;
  case Kind::frame_corrupted: received.frame.data[0] ^= 1U; break;
  case Kind::frame_late: withheld_.push_back(received); return receive();
  case Kind::frame_of_other: received.frame.id = (received.frame.id & ~0x7FU) | other_node; break;
  default: break;
  }
  return received;
}

} // namespace blactl::campaign
