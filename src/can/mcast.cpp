#include "blactl/can/mcast.hpp"

#include "blactl/base/system_error.hpp"

#include "can/ip_link.hpp"
#include "can/mcast_datagram.hpp"
#include "can/socket_batch.hpp"
#include "can/texts.hpp"

#include <arpa/inet.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <utility>

namespace blactl::can {
namespace {

constexpr std::uint16_t port = 57732;

/// The group of bus 0; the last byte is the number of the bus.
constexpr std::uint32_t groups = 0xEF41'5200; // 239.65.82.0

sockaddr_in group_of(std::uint8_t number) {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(port);
  group.sin_addr.s_addr = htonl(groups | number);
  return group;
}

/// Why this interface cannot carry a bus now, if it cannot.
std::optional<Error> unusable(const IpLink& link) {
  const std::string name = printable(link.name);
  if (!link.is_up) {
    return Error{Code::interface, say<texts::interface_down>(name),
                 say<texts::bring_up_hint>("sudo ip link set " + name + " up")};
  }
  // Without one, datagrams would leave with the address of another interface, or not at all.
  if (!link.address) {
    return Error{Code::interface, say<texts::mcast_no_address>(name),
                 say<texts::mcast_no_address_hint>(name)};
  }
  return std::nullopt;
}

const sockaddr* raw(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

int open_socket() {
  return ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

bool same(const sockaddr_in& one, const sockaddr_in& other) {
  return one.sin_addr.s_addr == other.sin_addr.s_addr && one.sin_port == other.sin_port;
}

} // namespace

using Batch = SocketBatch<std::array<std::uint8_t, Datagram::max_size>, sockaddr_in>;

struct Mcast::Message : Batch::Message {};

Mcast::Mcast(std::uint8_t number, const IpLink& link)
    : name_("mcast:" + std::to_string(number) + "?if=" + printable(link.name)),
      link_name_(link.name), link_index_(link.index), group_(group_of(number)),
      links_(std::make_unique<IpLinkWatch>()) {}

Mcast::~Mcast() = default;

Result<std::unique_ptr<Bus>> Mcast::open(std::uint8_t number, std::string_view interface) {
  const auto link = interface.empty() ? ip_link_towards(group_of(number).sin_addr)
                                      : ip_link(std::string(interface));
  if (!link) {
    return fail(Code::interface, say<texts::no_such_interface>(printable(interface)),
                describe_ip_links());
  }
  if (auto error = unusable(*link)) {
    return std::unexpected(std::move(*error));
  }
  std::unique_ptr<Mcast> bus(new Mcast(number, *link));
  // The watch comes first: a change before it makes connect() fail.
  auto opened = bus->watch();
  if (opened) {
    opened = bus->connect(*link->address);
  }
  if (opened) {
    opened = bus->listen();
  }
  if (!opened) {
    return std::unexpected(std::move(opened.error()));
  }
  return bus;
}

/// The socket that receives, from this one interface only.
Result<void> Mcast::listen() {
  in_ = Descriptor(open_socket());
  const ip_mreqn membership{group_.sin_addr, {}, link_index_};
  // Every program of this machine binds to the same port. SO_REUSEPORT would share the datagrams
  // out among them. IP_MULTICAST_ALL would deliver those of other programs' memberships.
  if (in_.get() < 0 || !set_option(in_.get(), SOL_SOCKET, SO_REUSEADDR, 1) ||
      !set_option(in_.get(), IPPROTO_IP, IP_MULTICAST_ALL, 0) || !prepare_to_receive(in_.get()) ||
      bind(in_.get(), raw(group_), sizeof group_) != 0 ||
      !set_option(in_.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, membership)) {
    return std::unexpected(broken(errno));
  }
  epoll_event wanted{};
  wanted.events = EPOLLIN;
  if (epoll_ctl(either_.get(), EPOLL_CTL_ADD, in_.get(), &wanted) != 0) {
    return std::unexpected(broken(errno));
  }
  return {};
}

/// The socket that sends: connected, so that its address is known.
Result<void> Mcast::connect(in_addr source) {
  out_ = Descriptor(open_socket());
  const ip_mreqn leave_by{{}, source, link_index_};
  socklen_t size = sizeof own_;
  if (out_.get() < 0 || !set_option(out_.get(), IPPROTO_IP, IP_MULTICAST_IF, leave_by) ||
      !set_option(out_.get(), IPPROTO_IP, IP_MULTICAST_TTL, 1) ||
      !set_option(out_.get(), IPPROTO_IP, IP_MULTICAST_LOOP, 1) ||
      ::connect(out_.get(), raw(group_), sizeof group_) != 0 ||
      getsockname(out_.get(), reinterpret_cast<sockaddr*>(&own_), &size) != 0) {
    return std::unexpected(broken(errno));
  }
  return {};
}

Result<void> Mcast::watch() {
  either_ = Descriptor(epoll_create1(EPOLL_CLOEXEC));
  epoll_event wanted{};
  wanted.events = EPOLLIN;
  if (!links_->open() || either_.get() < 0 ||
      epoll_ctl(either_.get(), EPOLL_CTL_ADD, links_->descriptor(), &wanted) != 0) {
    return std::unexpected(broken(errno));
  }
  return {};
}

/// Why the interface can no longer be used, if it cannot.
std::optional<Error> Mcast::broken_link() const {
  const auto link = ip_link(link_index_);
  if (!link) {
    return Error{Code::interface, say<texts::interface_gone>(printable(link_name_)),
                 say<texts::interface_gone_hint>()};
  }
  return unusable(*link);
}

/// The error of a system call, or that of the interface if it is the cause.
Error Mcast::broken(int error) const {
  if (auto link = broken_link()) {
    return *link;
  }
  if (error == EPERM || error == EACCES) {
    return {Code::permission, say<texts::mcast_not_permitted>(name_, system_reason(error)),
            say<texts::mcast_not_permitted_hint>(port)};
  }
  if (error == EADDRINUSE) {
    return {Code::interface, say<texts::mcast_port_taken>(name_, port),
            say<texts::mcast_port_taken_hint>(port)};
  }
  return {Code::interface, say<texts::mcast_failed>(name_, system_reason(error))};
}

Result<bool> Mcast::send(const Frame& frame) {
  const Datagram datagram = to_datagram(frame);
  if (::send(out_.get(), datagram.bytes.data(), datagram.size, 0) >= 0) {
    return true;
  }
  if (errno == ENOBUFS || errno == EAGAIN) {
    return false;
  }
  return std::unexpected(broken(errno));
}

std::optional<BusEvent> Mcast::receive() {
  if (ready_.empty()) {
    read();
  }
  if (ready_.empty() && links_->changed()) {
    if (auto error = broken_link()) {
      return Gone{std::move(*error)};
    }
  }
  if (ready_.empty()) {
    return std::nullopt;
  }
  BusEvent event = std::move(ready_.front());
  ready_.pop_front();
  return event;
}

void Mcast::read() {
  Batch batch;
  // Our own datagrams and garbage are not events; a flood of them must not hold us here.
  for (int i = 0; i < 64 && ready_.empty(); ++i) {
    const int count = batch.take(in_.get());
    if (count < 0) {
      if (errno != EAGAIN && errno != EINTR) {
        ready_.emplace_back(Gone{broken(errno)});
      }
      return;
    }
    arrivals_.read_at(now(), wall());
    for (int at = 0; at < count; ++at) {
      take({batch.message(at)});
    }
  }
}

void Mcast::take(const Message& message) {
  const auto arrival = arrivals_.arrival(message.aside);
  if (arrival.before) {
    ready_.emplace_back(*arrival.before);
  }
  if (same(message.from, own_)) {
    return;
  }
  const bool whole = (message.flags & MSG_TRUNC) == 0;
  const auto bytes = std::span(message.content).first(message.size);
  if (const auto frame = whole ? from_datagram(bytes) : std::nullopt) {
    ready_.emplace_back(Received{*frame, arrival.at, arrival.wall});
  } else {
    ++unreadable_;
  }
}

} // namespace blactl::can
