#pragma once
// A DroneCAN bus over UDP multicast, as pydronecan, ArduPilot SITL and libcanard speak it.

#include "blactl/can/arrivals.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/can/descriptor.hpp"

#include <netinet/in.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::can {

struct IpLink;
class IpLinkWatch;

/// One CAN frame per datagram to 239.65.82.N, port 57732 (DroneCAN specification 4.2); frames go no
/// further than the next router. Membership and sending are bound to one and the same network
/// interface: the kernel alone would choose one by the route and the other by the source address.
///
/// There is no acknowledgement, and datagrams are lost silently. Only classic CAN.
class Mcast final : public Bus {
 public:
  /// `interface`: a network interface by name; empty: the one the routes choose for the group, else
  /// loopback. Errors: interface (none of this name, down, without IPv4 address), permission.
  [[nodiscard]] static Result<std::unique_ptr<Bus>> open(std::uint8_t number,
                                                         std::string_view interface);
  ~Mcast() override;
  Mcast(const Mcast&) = delete;
  Mcast& operator=(const Mcast&) = delete;

  /// "mcast:0?if=lo"
  [[nodiscard]] std::string_view name() const override { return name_; }

  [[nodiscard]] Result<bool> send(const Frame& frame) override;
  [[nodiscard]] std::optional<BusEvent> receive() override;

  /// Passes everything: datagrams are cheap to read, and the kernel cannot filter by their content.
  [[nodiscard]] Result<void> filter(std::span<const Filter> /*filters*/) override { return {}; }

  [[nodiscard]] bool echoes() const override { return false; }

  [[nodiscard]] int descriptor() const override { return either_.get(); }

  [[nodiscard]] std::uint64_t unreadable() const override { return unreadable_; }

 private:
  struct Message;

  Mcast(std::uint8_t number, const IpLink& link);

  Result<void> listen();
  Result<void> connect(in_addr source);
  Result<void> watch();
  void read();
  void take(const Message& message);
  [[nodiscard]] std::optional<Error> broken_link() const;
  [[nodiscard]] Error broken(int error) const;

  std::string name_;
  std::string link_name_;
  int link_index_;
  sockaddr_in group_{};
  sockaddr_in own_{}; ///< The source of our datagrams, which come back like all others.
  Descriptor in_;
  Descriptor out_;
  std::unique_ptr<IpLinkWatch> links_; ///< Needed because a UDP socket does not report link state.
  Descriptor either_;                  ///< Readable when `in_` or `links_` is (epoll).
  std::deque<BusEvent> ready_;
  Arrivals arrivals_;
  std::uint64_t unreadable_ = 0;
};

} // namespace blactl::can
