#pragma once
// Owners of libnl objects.

#include <netlink/cache.h>
#include <netlink/netlink.h>
#include <netlink/route/link.h>

#include <memory>

namespace blactl::can {

using NlSocket = std::unique_ptr<nl_sock, decltype(&nl_socket_free)>;
using NlCache = std::unique_ptr<nl_cache, decltype(&nl_cache_free)>;
using NlLink = std::unique_ptr<rtnl_link, decltype(&rtnl_link_put)>;

} // namespace blactl::can
