#include "can/socket_batch.hpp"

#include "can/kernel_frame.hpp"

#include <chrono>
#include <cstdint>
#include <cstring>
#include <tuple>

namespace blactl::can {
namespace {

/// Bytes asked for; the kernel takes double, room for some 20,000 frames: 3 s of a full bus.
constexpr int receive_buffer = 8 << 20;

template <class T> T content(const cmsghdr& control) {
  T value{};
  std::memcpy(&value, CMSG_DATA(&control), sizeof value);
  return value;
}

WallTime wall_time(const timespec& stamp) {
  return WallTime(std::chrono::floor<Duration>(std::chrono::seconds(stamp.tv_sec) +
                                               std::chrono::nanoseconds(stamp.tv_nsec)));
}

} // namespace

bool prepare_to_receive(int descriptor) {
  // The first option requires CAP_NET_ADMIN, the second stays below net.core.rmem_max.
  if (!set_option(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, receive_buffer)) {
    std::ignore = set_option(descriptor, SOL_SOCKET, SO_RCVBUF, receive_buffer);
  }
  return set_option(descriptor, SOL_SOCKET, SO_TIMESTAMPNS, 1) &&
         set_option(descriptor, SOL_SOCKET, SO_RXQ_OVFL, 1);
}

Aside aside(const msghdr& header) {
  Aside told;
  auto* rest = const_cast<msghdr*>(&header); // NOLINT: CMSG_NXTHDR only reads, but does not say so
  for (auto* control = CMSG_FIRSTHDR(rest); control != nullptr;
       control = CMSG_NXTHDR(rest, control)) {
    if (control->cmsg_level != SOL_SOCKET) {
      continue;
    }
    if (control->cmsg_type == SCM_TIMESTAMPNS) {
      told.stamp = wall_time(content<timespec>(*control));
    } else if (control->cmsg_type == SO_RXQ_OVFL) {
      told.dropped = content<std::uint32_t>(*control);
    }
  }
  return told;
}

void Arrivals::read_at(Time now, WallTime wall) {
  now_ = now;
  wall_ = wall;
}

Arrivals::Arrival Arrivals::arrival(const Aside& aside) {
  const WallTime stamp = aside.stamp.value_or(wall_);
  last_ = bus_time(stamp, now_, wall_, last_);
  Arrival arrival{last_, stamp, std::nullopt};
  if (aside.dropped && *aside.dropped != dropped_) {
    lost_ += *aside.dropped - dropped_;
    dropped_ = *aside.dropped;
    arrival.before = Overflow{lost_};
  }
  return arrival;
}

} // namespace blactl::can
