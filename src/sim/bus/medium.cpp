#include "blactl/sim/bus/medium.hpp"

#include "blactl/can/frame_bits.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace blactl::sim {
namespace {

constexpr Duration bits(std::size_t n) {
  return Duration(n);
}

// ISO 11898-1: the counter rises by 8 with an error; from 128 a node is error passive; beyond 255
// it is bus-off and returns after 128 times 11 recessive bits.
constexpr unsigned error_step = 8;
constexpr unsigned error_passive = 128;
constexpr unsigned error_limit = 255;
constexpr Duration off_time = bits(std::size_t{128} * 11);

/// Six bits of error flag, up to six bits until the last flag of the others, eight of delimiter.
constexpr std::size_t error_frame_bits = 6 + 6 + 8;

/// The arbitration order of frames: a dominant bit is 0.
auto strength(const can::Frame& frame) {
  return std::tuple(can::arbitration_field(frame), frame.size, frame.data);
}

} // namespace

Time Medium::Port::ready() const {
  return queue.empty() || cut ? never : std::max(queue.front().since, off_until);
}

void Medium::cut(PortId port, bool is_cut, Time now) {
  if (!on_wire_) {
    idle_from_ = std::max(idle_from_, now); // waiting frames do not start in the past
  }
  ports_.at(port).cut = is_cut;
}

void Medium::bus_off(PortId port, Time now) {
  if (on_wire_ && std::ranges::find(on_wire_->senders, port) != on_wire_->senders.end()) {
    on_wire_->destroyed = true;
  }
  leave(ports_.at(port), now);
}

Medium::PortId Medium::attach(Listener& listener, std::size_t capacity, Time now) {
  // A frame that waited for an acknowledgement does not start in the past.
  if (!on_wire_) {
    idle_from_ = std::max(idle_from_, now);
  }
  const PortId id = next_id_++;
  ports_.emplace(id, Port{&listener, capacity, {}, 0, {}, false});
  return id;
}

void Medium::detach(PortId port) {
  Port& leaving = ports_.at(port);
  leaving.listener = nullptr;
  if (leaving.queue.empty()) {
    ports_.erase(port);
  }
}

bool Medium::send(PortId port, const can::Frame& frame, Time now) {
  Port& from = ports_.at(port);
  if (from.queue.size() >= from.capacity) {
    return false;
  }
  from.queue.push_back({frame, now});
  return true;
}

Time Medium::next_start() const {
  if (std::ranges::count(ports_, false, [](const auto& entry) { return entry.second.cut; }) < 2) {
    return never; // no node would acknowledge
  }
  Time first = never;
  for (const auto& [id, port] : ports_) {
    first = std::min(first, port.ready());
  }
  return std::max(first, idle_from_);
}

Time Medium::next_event() const {
  return on_wire_ ? on_wire_->end : next_start();
}

void Medium::advance(Time now) {
  const Time at = next_event();
  if (at > now) {
    return;
  }
  if (on_wire_) {
    finish();
  } else {
    start(at);
  }
}

void Medium::start(Time at) {
  std::vector<PortId> contenders;
  for (const auto& [id, port] : ports_) {
    if (port.ready() <= at) {
      contenders.push_back(id);
    }
  }
  const auto head = [&](PortId id) { return ports_.at(id).queue.front().frame; };
  const auto best =
      std::ranges::min_element(contenders, {}, [&](PortId id) { return strength(head(id)); });
  if (best == contenders.end()) {
    return;
  }
  const can::Frame frame = head(*best);
  std::vector<PortId> senders;
  std::vector<PortId> rivals; // those that the arbitration does not separate
  for (const PortId id : contenders) {
    if (head(id) == frame) {
      senders.push_back(id);
    } else if (can::arbitration_field(head(id)) == can::arbitration_field(frame)) {
      rivals.push_back(id);
    }
  }
  begin(frame, std::move(senders), rivals, at);
}

/// A rival notices the difference: if it is error active, its error flag destroys the frame.
void Medium::begin(const can::Frame& frame, std::vector<PortId> senders,
                   const std::vector<PortId>& rivals, Time at) {
  const can::FrameBits own(frame);
  std::size_t length = can::frame_length(own);
  bool destroyed = false;
  for (const PortId rival : rivals) {
    const Port& port = ports_.at(rival);
    if (port.error_count < error_passive) {
      const std::size_t noticed =
          own.first_difference(can::FrameBits(port.queue.front().frame)) + 1;
      length = std::min(length, noticed + error_frame_bits);
      destroyed = true;
    }
  }
  for (const PortId rival : rivals) {
    punish(rival, at);
  }
  counters_.collisions += destroyed ? 1 : 0;
  if (!destroyed && disturbance_.destroys(at)) {
    ++counters_.errors;
    destroyed = true;
    length = own.size() + error_frame_bits; // all nodes notice it by the wrong CRC
  }
  if (destroyed) {
    for (const PortId sender : senders) {
      punish(sender, at);
    }
  }
  on_wire_ = Transmission{frame, std::move(senders), at + bits(length), destroyed};
  idle_from_ = on_wire_->end + bits(can::intermission_bits);
  counters_.busy += idle_from_ - at;
}

void Medium::punish(PortId port, Time at) {
  Port& guilty = ports_.at(port);
  guilty.error_count += error_step;
  if (guilty.error_count <= error_limit) {
    return;
  }
  leave(guilty, at);
}

void Medium::leave(Port& port, Time at) {
  port.error_count = 0;
  port.queue.clear();
  port.off_until = at + off_time;
  if (port.listener != nullptr) {
    port.listener->bus_off(at);
  }
}

void Medium::finish() {
  const Transmission done = *std::exchange(on_wire_, std::nullopt);
  if (!done.destroyed) {
    ++counters_.frames;
    const bool repeated = disturbance_.duplicates();
    if (!repeated) {
      release(done.senders);
    }
    deliver(done, repeated);
  }
  std::erase_if(ports_, [](const auto& entry) {
    return entry.second.listener == nullptr && entry.second.queue.empty();
  });
}

/// The frame is complete: its senders go on to their next one.
void Medium::release(const std::vector<PortId>& senders) {
  for (const PortId sender : senders) {
    Port& port = ports_.at(sender);
    port.queue.pop_front();
    port.error_count -= port.error_count > 0 ? 1 : 0;
  }
}

/// `repeated`: the senders do not know that it has arrived, and will repeat it.
void Medium::deliver(const Transmission& transmission, bool repeated) {
  const can::Frame received = disturbance_.received(transmission.frame);
  for (auto& [id, port] : ports_) {
    if (port.listener == nullptr || port.cut) {
      continue;
    }
    if (std::ranges::find(transmission.senders, id) == transmission.senders.end()) {
      if (!disturbance_.loses()) {
        port.listener->heard(received, transmission.end);
      }
    } else if (!repeated) {
      port.listener->sent(transmission.frame, transmission.end);
    }
  }
}

} // namespace blactl::sim
