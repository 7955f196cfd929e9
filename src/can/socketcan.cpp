#include "blactl/can/socketcan.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/can/link.hpp"
#include "blactl/can/link_setup.hpp"

#include "can/kernel_frame.hpp"
#include "can/socket_batch.hpp"
#include "can/texts.hpp"

#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace blactl::can {
namespace {

std::unexpected<Error> cannot_open_interface(std::string_view interface, int error) {
  const std::string name = printable(interface);
  if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT) {
    return fail(Code::interface, say<texts::kernel_without_can>(name),
                say<texts::kernel_without_can_hint>());
  }
  if (error == EPERM || error == EACCES) {
    return fail(Code::permission, say<texts::can_not_permitted>(name, system_reason(error)),
                say<texts::can_not_permitted_hint>());
  }
  return fail(Code::interface, say<texts::interface_failed>(name, system_reason(error)));
}

std::vector<Link> links_or_none() {
  return links().value_or(std::vector<Link>{});
}

} // namespace

Result<std::unique_ptr<Bus>> SocketCan::open(std::string_view interface) {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor < 0) {
    return cannot_open_interface(interface, errno);
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

/// Called before bind(), so that even the first frame has its ancillary data.
Result<void> SocketCan::configure() {
  const auto set = [this](int option, const auto& value) {
    return set_option(descriptor_, SOL_CAN_RAW, option, value);
  };
  const bool done = set(CAN_RAW_LOOPBACK, 1) && set(CAN_RAW_RECV_OWN_MSGS, 1) &&
                    set(CAN_RAW_ERR_FILTER, fault_classes) && prepare_to_receive(descriptor_);
  if (!done) {
    return std::unexpected(broken(errno));
  }
  return {};
}

Result<void> SocketCan::bind() {
  const unsigned index = if_nametoindex(name_.c_str());
  if (index == 0) {
    return fail(Code::interface, say<texts::no_such_interface>(printable(name_)),
                describe(links_or_none()));
  }
  // An alternative name (ip link property) opens it too; other tools show the first.
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
               : cannot_open_interface(name_, errno);
  }
  // Binding to an interface that is down succeeds; the socket then holds the error.
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

/// The error of a socket that worked before, explained by the state of the interface.
Error SocketCan::broken(int error) const {
  const std::string name = printable(name_);
  const bool down = error == ENETDOWN;
  if (!down && error != ENODEV && error != ENXIO) {
    return {Code::interface, say<texts::interface_failed>(name, system_reason(error))};
  }
  // An interface that disappears goes down first, so the kernel's error is not the final one.
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
  SocketBatch<can_frame, sockaddr_can> batch;
  const int count = batch.take(descriptor_);
  if (count < 0) {
    if (errno != EAGAIN && errno != EINTR) {
      ready_.emplace_back(Gone{broken(errno)});
    }
    return;
  }
  arrivals_.read_at(now(), wall());
  for (int i = 0; i < count; ++i) {
    const auto message = batch.message(i);
    if (message.size == sizeof(can_frame) && (message.flags & MSG_TRUNC) == 0) {
      take(message.content, (message.flags & MSG_CONFIRM) != 0, arrivals_.arrival(message.aside));
    }
  }
}

/// Turns one message into events: first the loss before it, then the frame.
void SocketCan::take(const can_frame& frame, bool is_own, const Arrivals::Arrival& arrival) {
  if (arrival.before) {
    ready_.emplace_back(*arrival.before);
  }
  if ((frame.can_id & CAN_ERR_FLAG) != 0) {
    for (const FaultKind kind : faults(frame)) {
      ready_.emplace_back(BusFault{kind, arrival.at});
    }
  } else if (is_own) {
    ready_.emplace_back(Sent{from_kernel(frame), arrival.at, arrival.wall});
  } else {
    ready_.emplace_back(Received{from_kernel(frame), arrival.at, arrival.wall});
  }
}

std::string SocketCan::bus_off_hint() const {
  return say<texts::bus_off_of_kernel_hint>(name_);
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
