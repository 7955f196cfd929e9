#include "can/ip_link.hpp"

#include "can/texts.hpp"

#include <netlink/addr.h>
#include <netlink/netlink.h>
#include <netlink/route/nexthop.h>
#include <netlink/route/route.h>

#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

namespace blactl::can {
namespace {

/// Asks the kernel about the interface named in `request`.
bool ask(unsigned long what, ifreq& request) {
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return socket.get() >= 0 && ioctl(socket.get(), what, &request) == 0;
}

ifreq named(const std::string& name) {
  ifreq request{};
  name.copy(request.ifr_name, sizeof request.ifr_name - 1); // NOLINT: a union of the kernel's
  return request;
}

/// The index of the interface chosen by the routes; 0: no route, or rtnetlink does not answer.
int route_towards(in_addr group) {
  const std::unique_ptr<nl_sock, decltype(&nl_socket_free)> socket(nl_socket_alloc(),
                                                                   &nl_socket_free);
  const std::unique_ptr<nl_addr, decltype(&nl_addr_put)> address(
      nl_addr_build(AF_INET, &group, sizeof group), &nl_addr_put);
  rtnl_route* found = nullptr;
  if (!socket || !address || nl_connect(socket.get(), NETLINK_ROUTE) != 0 ||
      rtnl_route_lookup(socket.get(), address.get(), &found) != 0) {
    return 0;
  }
  const std::unique_ptr<rtnl_route, decltype(&rtnl_route_put)> route(found, &rtnl_route_put);
  rtnl_nexthop* hop = rtnl_route_nexthop_n(found, 0);
  return hop != nullptr ? rtnl_route_nh_get_ifindex(hop) : 0;
}

using Names = std::unique_ptr<struct if_nameindex, decltype(&if_freenameindex)>;

} // namespace

std::optional<IpLink> ip_link(int index) {
  std::array<char, IF_NAMESIZE> name{};
  if (if_indextoname(static_cast<unsigned>(index), name.data()) == nullptr) {
    return std::nullopt;
  }
  IpLink link{.index = index, .name = name.data()};
  ifreq flags = named(link.name);
  link.is_up = ask(SIOCGIFFLAGS, flags) && (flags.ifr_flags & IFF_UP) != 0; // NOLINT: a union
  ifreq address = named(link.name);
  if (ask(SIOCGIFADDR, address)) {
    sockaddr_in first{};
    std::memcpy(&first, &address.ifr_addr, sizeof first); // NOLINT: a union
    link.address = first.sin_addr;
  }
  return link;
}

std::optional<IpLink> ip_link(const std::string& name) {
  const unsigned index = if_nametoindex(name.c_str());
  return index != 0 ? ip_link(static_cast<int>(index)) : std::nullopt;
}

std::optional<IpLink> ip_link_towards(in_addr group) {
  constexpr int loopback = 1; // LOOPBACK_IFINDEX of the kernel (net/flow.h)
  const int chosen = route_towards(group);
  return ip_link(chosen != 0 ? chosen : loopback);
}

std::string describe_ip_links() {
  const Names names(if_nameindex(), &if_freenameindex);
  std::string list;
  for (const auto* entry = names.get(); entry != nullptr && entry->if_index != 0; ++entry) {
    list += (list.empty() ? "" : ", ") + printable(entry->if_name);
  }
  return say<texts::ip_links_here>(list);
}

bool IpLinkWatch::open() {
  constexpr int type = SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC;
  socket_ = Descriptor(::socket(AF_NETLINK, type, NETLINK_ROUTE));
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = RTMGRP_LINK;
  return socket_.get() >= 0 &&
         bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

/// Does not read what changed: only the present state counts, and messages may be lost.
bool IpLinkWatch::changed() {
  bool any = false;
  char part = 0;
  while (recv(socket_.get(), &part, sizeof part, MSG_TRUNC) >= 0 || errno == ENOBUFS) {
    any = true;
  }
  return any;
}

} // namespace blactl::can
