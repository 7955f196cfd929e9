#include "blactl/fleet/traffic.hpp"

#include "blactl/can/frame_bits.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::fleet {

void Traffic::hear(const can::Frame& frame, Time at) {
  const auto bits = can::frame_length(frame) + can::intermission_bits;
  first_ = first_.value_or(at);
  last_ = at;
  ++frames_;
  bits_ += bits;
  if (!frame.extended) {
    ++standard_frames_;
    return;
  }
  const auto header = dronecan::decode_id(frame.id);
  if (!header) {
    return;
  }
  Sender& sender = senders_[header->source];
  ++sender.frames;
  sender.bits += bits;
  sender.statuses += header->kind == dronecan::Kind::message &&
                             header->data_type_id == dronecan::NodeStatus::type.id
                         ? 1U
                         : 0U;
}

void Traffic::hear_own(const can::Frame& frame, Time at) {
  hear(frame, at);
  ++own_frames_;
}

void Traffic::stamp(WallTime wall) {
  constexpr Duration disorder = std::chrono::seconds(1); // of logs of several interfaces
  runs_backwards_ = runs_backwards_ || wall + disorder < newest_;
  newest_ = std::max(newest_, wall);
}

void Traffic::hear(const can::BusFault& fault) {
  ++faults_[fault.kind];
}

std::optional<Duration> Traffic::duration() const {
  return first_ && last_ > *first_ && !runs_backwards_ ? std::optional(last_ - *first_)
                                                       : std::nullopt;
}

std::optional<std::uint64_t> Traffic::load_permille() const {
  const auto time = duration();
  if (!time) {
    return std::nullopt;
  }
  // At 1 Mbit/s a bit takes 1 us.
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(*time).count();
  return us > 0 ? std::optional(bits_ * 1000 / static_cast<std::uint64_t>(us)) : std::nullopt;
}

} // namespace blactl::fleet
