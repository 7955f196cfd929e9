#include "blactl/can/link.hpp"

#include "can/rtnl.hpp"
#include "can/texts.hpp"

#include <netlink/route/link/can.h>

#include <net/if.h>
#include <net/if_arp.h>

namespace blactl::can {
namespace {

Link read(rtnl_link* raw) {
  Link link;
  link.name = rtnl_link_get_name(raw);
  if (const char* kind = rtnl_link_get_type(raw)) {
    link.kind = kind;
  }
  link.is_up = (rtnl_link_get_flags(raw) & IFF_UP) != 0;
  link.queue_length = rtnl_link_get_txqlen(raw);
  return link;
}

/// Reads what only a controller has. libnl aborts the program if asked this of another kind.
void read_controller(rtnl_link* raw, Link& link) {
  can_bittiming timing{};
  if (rtnl_link_can_get_bittiming(raw, &timing) == 0 && timing.bitrate != 0) {
    link.bit_rate = timing.bitrate;
    if (timing.sample_point != 0) {
      link.sample_point = timing.sample_point;
    }
  }
  std::uint32_t value = 0;
  if (rtnl_link_can_get_restart_ms(raw, &value) == 0) {
    link.restart_after = std::chrono::milliseconds(value);
  }
  if (rtnl_link_can_state(raw, &value) == 0 && value < CAN_STATE_MAX) {
    link.state = static_cast<LinkState>(value);
  }
  can_berr_counter errors{};
  if (rtnl_link_can_berr(raw, &errors) == 0) {
    link.errors = ErrorCounters{errors.txerr, errors.rxerr};
  }
}

static_assert(static_cast<int>(LinkState::bus_off) == CAN_STATE_BUS_OFF &&
              static_cast<int>(LinkState::sleeping) == CAN_STATE_SLEEPING);

} // namespace

Result<std::vector<Link>> links() {
  const NlSocket socket(nl_socket_alloc(), &nl_socket_free);
  nl_cache* raw_cache = nullptr;
  int error = socket ? nl_connect(socket.get(), NETLINK_ROUTE) : -NLE_NOMEM;
  if (error == 0) {
    error = rtnl_link_alloc_cache(socket.get(), AF_UNSPEC, &raw_cache);
  }
  if (error < 0) {
    return fail(Code::interface, say<texts::links_unreadable>(nl_geterror(error)));
  }
  const NlCache cache(raw_cache, &nl_cache_free);
  std::vector<Link> found;
  for (auto* object = nl_cache_get_first(raw_cache); object != nullptr;
       object = nl_cache_get_next(object)) {
    auto* raw = reinterpret_cast<rtnl_link*>(object); // the downcast that libnl itself uses
    if (rtnl_link_get_arptype(raw) != ARPHRD_CAN) {
      continue;
    }
    found.push_back(read(raw));
    if (rtnl_link_is_can(raw) != 0) {
      read_controller(raw, found.back());
    }
  }
  return found;
}

const Link* only_one_up(std::span<const Link> links) {
  const Link* only = nullptr;
  for (const Link& link : links) {
    if (link.is_up && only != nullptr) {
      return nullptr;
    }
    if (link.is_up) {
      only = &link;
    }
  }
  return only;
}

std::string describe(std::span<const Link> links) {
  if (links.empty()) {
    return say<texts::no_can_interface_here>();
  }
  std::string list;
  for (const Link& link : links) {
    const std::string name = printable(link.name);
    list += list.empty() ? "" : ", ";
    list += link.is_up ? say<texts::link_is_up>(name) : say<texts::link_is_down>(name);
  }
  return say<texts::can_interfaces_here>(list);
}

} // namespace blactl::can
