#include "blactl/fleet/bus/traffic.hpp"

#include "blactl/can/frame_bits.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::fleet {

void Traffic::hear(const can::Frame& frame, Time at) {
  const auto bits = can::frame_length(frame) + can::intermission_bits;
  load_.hear(bits, at);
  ++frames_;
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
  if (header->kind == dronecan::Kind::message &&
      header->data_type_id == dronecan::NodeStatus::type.id && frame.size > 0) {
    take_status(sender, frame, at);
  }
}

/// NodeStatus is one frame. Consecutive transfer IDs tell that none was lost.
void Traffic::take_status(Sender& sender, const can::Frame& frame, Time at) {
  const dronecan::TransferId id = frame.data[frame.size - 1U] % dronecan::transfer_id_modulus;
  if (sender.statuses > 0 && id == (sender.status_id + 1U) % dronecan::transfer_id_modulus) {
    sender.longest_status_period = std::max(sender.longest_status_period, at - sender.status_at);
  }
  sender.status_id = id;
  sender.status_at = at;
  ++sender.statuses;
}

void Traffic::hear_own(const can::Frame& frame, Time at) {
  hear(frame, at);
  ++own_frames_;
}

void Traffic::stamp(WallTime wall) {
  constexpr Duration disorder = std::chrono::seconds(1); // in logs of several interfaces
  runs_backwards_ = runs_backwards_ || wall + disorder < newest_;
  newest_ = std::max(newest_, wall);
}

void Traffic::hear(const can::BusFault& fault) {
  ++faults_[fault.kind];
}

std::optional<Duration> Traffic::duration() const {
  return runs_backwards_ ? std::nullopt : load_.duration();
}

std::optional<std::uint64_t> Traffic::load_permille() const {
  return runs_backwards_ ? std::nullopt : load_.mean_permille();
}

} // namespace blactl::fleet
