#include "blactl/can/socketcan.hpp"

#include "blactl/can/link.hpp"
#include "blactl/can/texts.hpp"

#include "can/kernel_frame.hpp"

#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace blactl::can {
namespace {

/// Bytes asked for; the kernel takes double, room for some 20,000 frames: 3 s of a full bus.
constexpr int receive_buffer = 8 << 20;

/// Frames taken from the kernel with one call.
constexpr std::size_t batch_size = 16;

template <class T> T content(const cmsghdr& control) {
  T value{};
  std::memcpy(&value, CMSG_DATA(&control), sizeof value);
  return value;
}

WallTime wall_time(const timespec& stamp) {
  return WallTime(std::chrono::floor<Duration>(std::chrono::seconds(stamp.tv_sec) +
                                               std::chrono::nanoseconds(stamp.tv_nsec)));
}

template <class T> bool set_option(int descriptor, int level, int option, const T& value) {
  return setsockopt(descriptor, level, option, &value, sizeof value) == 0;
}

std::string reason(int error) {
  return std::system_category().message(error);
}

std::unexpected<Error> cannot_open(std::string_view interface, int error) {
  const std::string name = printable(interface);
  if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT) {
    return fail(Code::interface, say<texts::kernel_without_can>(name),
                say<texts::kernel_without_can_hint>());
  }
  if (error == EPERM || error == EACCES) {
    return fail(Code::permission, say<texts::can_not_permitted>(name, reason(error)),
                say<texts::can_not_permitted_hint>());
  }
  return fail(Code::interface, say<texts::interface_failed>(name, reason(error)));
}

std::vector<Link> links_or_none() {
  return links().value_or(std::vector<Link>{});
}

} // namespace

/// A frame with what the kernel tells beside it.
struct SocketCan::Incoming {
  Incoming(const can_frame& raw, const msghdr& header);

  can_frame frame;
  bool is_own;
  std::optional<WallTime> stamp;
  std::optional<std::uint32_t> dropped; ///< Frames that had no room before this one.
};

SocketCan::Incoming::Incoming(const can_frame& raw, const msghdr& header)
    : frame(raw), is_own((header.msg_flags & MSG_CONFIRM) != 0) {
  auto* rest = const_cast<msghdr*>(&header); // NOLINT: CMSG_NXTHDR only reads, but does not say so
  for (auto* control = CMSG_FIRSTHDR(rest); control != nullptr;
       control = CMSG_NXTHDR(rest, control)) {
    if (control->cmsg_level != SOL_SOCKET) {
      continue;
    }
    if (control->cmsg_type == SCM_TIMESTAMPNS) {
      stamp = wall_time(content<timespec>(*control));
    } else if (control->cmsg_type == SO_RXQ_OVFL) {
      dropped = content<std::uint32_t>(*control);
    }
  }
}

Result<std::unique_ptr<Bus>> SocketCan::open(std::string_view interface) {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor < 0) {
    return cannot_open(interface, errno);
  }
  std::unique_ptr<SocketCan> bus(new SocketCan(interface, descriptor));
  if (auto configured = bus->configure(); !configured) {
    return std::unexpected(std::move(configured.error()));
  }
  if (auto bound = bus->bind(); !bound) {
    return std::unexpected(std::move(bound.error()));
  }
  return bus;
}

SocketCan::~SocketCan() {
  close(descriptor_);
}

/// Before bind(), so that the very first frame is seen with all of it.
Result<void> SocketCan::configure() {
  const auto set = [this](int level, int option, const auto& value) {
    return set_option(descriptor_, level, option, value);
  };
  const bool done = set(SOL_CAN_RAW, CAN_RAW_LOOPBACK, 1) &&
                    set(SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1) &&
                    set(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, fault_classes) &&
                    set(SOL_SOCKET, SO_TIMESTAMPNS, 1) && set(SOL_SOCKET, SO_RXQ_OVFL, 1);
  if (!done) {
    return std::unexpected(broken(errno));
  }
  // The first is for administrators only, the second stays below net.core.rmem_max.
  if (!set(SOL_SOCKET, SO_RCVBUFFORCE, receive_buffer)) {
    std::ignore = set(SOL_SOCKET, SO_RCVBUF, receive_buffer);
  }
  return {};
}

Result<void> SocketCan::bind() {
  const unsigned index = if_nametoindex(name_.c_str());
  if (index == 0) {
    return fail(Code::interface, say<texts::no_such_interface>(printable(name_)),
                describe(links_or_none()));
  }
  // An alternative name (ip link property) opens it too; the others know it by the first.
  if (std::array<char, IF_NAMESIZE> first{}; if_indextoname(index, first.data()) != nullptr) {
    name_ = first.data();
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return errno == ENODEV
               ? fail(Code::interface, say<texts::not_a_can_interface>(printable(name_)),
                      describe(links_or_none()))
               : cannot_open(name_, errno);
  }
  // An interface that is down can be bound; the socket then holds the error.
  int error = 0;
  socklen_t size = sizeof error;
  if (getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
    error = errno;
  }
  if (error != 0) {
    return std::unexpected(broken(error));
  }
  return {};
}

/// The error of a socket that worked before, told as what became of the interface.
Error SocketCan::broken(int error) const {
  const std::string name = printable(name_);
  const bool down = error == ENETDOWN;
  if (!down && error != ENODEV && error != ENXIO) {
    return {Code::interface, say<texts::interface_failed>(name, reason(error))};
  }
  // An interface that goes away goes down first: the kernel's word is not the last one.
  const auto all = links_or_none();
  const auto link = std::ranges::find(all, name_, &Link::name);
  if (!down || link == all.end()) {
    return {Code::interface, say<texts::interface_gone>(name), say<texts::interface_gone_hint>()};
  }
  return {Code::interface, say<texts::interface_down>(name),
          say<texts::bring_up_hint>(up_command(*link))};
}

Result<bool> SocketCan::send(const Frame& frame) {
  if (widen(echoes_, frame.id) && !filters_.empty()) {
    if (auto applied = apply_filters(); !applied) {
      return std::unexpected(std::move(applied.error()));
    }
  }
  const can_frame raw = to_kernel(frame);
  if (write(descriptor_, &raw, sizeof raw) == sizeof raw) {
    return true;
  }
  if (errno == ENOBUFS || errno == EAGAIN) {
    return false;
  }
  return std::unexpected(broken(errno));
}

std::optional<BusEvent> SocketCan::receive() {
  if (ready_.empty()) {
    read_batch();
  }
  if (ready_.empty()) {
    return std::nullopt;
  }
  BusEvent event = std::move(ready_.front());
  ready_.pop_front();
  return event;
}

void SocketCan::read_batch() {
  struct Slot {
    can_frame frame;
    alignas(cmsghdr) std::array<std::byte, 64> control;
    iovec part;
  };

  std::array<Slot, batch_size> slots{};
  std::array<mmsghdr, batch_size> messages{};
  for (std::size_t i = 0; i < batch_size; ++i) {
    slots[i].part = {&slots[i].frame, sizeof(can_frame)};
    messages[i].msg_hdr.msg_iov = &slots[i].part;
    messages[i].msg_hdr.msg_iovlen = 1;
    messages[i].msg_hdr.msg_control = slots[i].control.data();
    messages[i].msg_hdr.msg_controllen = slots[i].control.size();
  }
  const int count = recvmmsg(descriptor_, messages.data(), batch_size, 0, nullptr);
  if (count < 0) {
    if (errno != EAGAIN && errno != EINTR) {
      ready_.emplace_back(Gone{broken(errno)});
    }
    return;
  }
  const WallTime clock = wall();
  const Time read_at = now();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const msghdr& header = messages[i].msg_hdr;
    if (messages[i].msg_len == sizeof(can_frame) && (header.msg_flags & MSG_TRUNC) == 0) {
      take({slots[i].frame, header}, read_at, clock);
    }
  }
}

/// Turns what was read into events: first what was lost before it, then the frame.
void SocketCan::take(const Incoming& incoming, Time now, WallTime wall) {
  if (incoming.dropped && *incoming.dropped != dropped_) {
    lost_ += *incoming.dropped - dropped_;
    dropped_ = *incoming.dropped;
    ready_.emplace_back(Overflow{lost_});
  }
  const WallTime stamp = incoming.stamp.value_or(wall);
  last_ = bus_time(stamp, now, wall, last_);
  if ((incoming.frame.can_id & CAN_ERR_FLAG) != 0) {
    for (const FaultKind kind : faults(incoming.frame)) {
      ready_.emplace_back(BusFault{kind, last_});
    }
  } else if (incoming.is_own) {
    ready_.emplace_back(Sent{from_kernel(incoming.frame), last_, stamp});
  } else {
    ready_.emplace_back(Received{from_kernel(incoming.frame), last_, stamp});
  }
}

Result<void> SocketCan::filter(std::span<const Filter> filters) {
  filters_.assign(filters.begin(), filters.end());
  return apply_filters();
}

Result<void> SocketCan::apply_filters() {
  const auto raw = kernel_filters(filters_, echoes_);
  const auto size = static_cast<socklen_t>(raw.size() * sizeof raw.front());
  if (setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(), size) != 0) {
    return std::unexpected(broken(errno));
  }
  return {};
}

} // namespace blactl::can
