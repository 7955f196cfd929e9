#pragma once
// The network interfaces of this machine as IPv4 multicast needs them.

#include "blactl/base/error.hpp"
#include "blactl/can/descriptor.hpp"

#include <netinet/in.h>

#include <optional>
#include <string>

namespace blactl::can {

struct IpLink {
  int index = 0; ///< The kernel's index; stays when the name changes.
  std::string name{};
  bool is_up = false;
  std::optional<in_addr> address{}; ///< The first address.
};

/// Empty: there is no such interface.
[[nodiscard]] std::optional<IpLink> ip_link(int index);

/// Also finds it by an alternative name (ip link property).
[[nodiscard]] std::optional<IpLink> ip_link(const std::string& name);

/// The interface that the routes choose for datagrams to `group`, else the loopback interface.
[[nodiscard]] std::optional<IpLink> ip_link_towards(in_addr group);

/// For a person: "interfaces of this machine: lo, eth0".
[[nodiscard]] std::string describe_ip_links();

/// Reports any change of an interface of this machine (rtnetlink, RTMGRP_LINK).
class IpLinkWatch {
 public:
  /// False: cannot watch; errno has the reason.
  [[nodiscard]] bool open();

  /// Readable when something changed.
  [[nodiscard]] int descriptor() const { return socket_.get(); }

  /// Whether something changed since the last call.
  [[nodiscard]] bool changed();

 private:
  Descriptor socket_;
};

} // namespace blactl::can
