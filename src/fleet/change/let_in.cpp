#include "blactl/fleet/change/let_in.hpp"

#include "blactl/fleet/change/allocation_service.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::fleet {
namespace {

using namespace std::chrono_literals;

/// For a unit to get an ID and to be heard under it: allocation takes about 1 s, one after the
/// other.
constexpr Duration least_time = 5s;
constexpr Duration time_for_one = 2s;

/// Without a request for so long nobody asks any more, even if one was lost (1.Allocation.uavcan).
constexpr Duration quiet_time = 3s;

} // namespace

Result<void> let_in(Session& session, state::AllocationStore& table) {
  if (!session.roster().allocators().empty()) {
    return {}; // it is another's to do
  }
  AllocationService service(session, table, {}, [](auto, const auto&) {});
  service.bus_is_known();
  const auto count = static_cast<Duration::rep>(session.roster().pending().size());
  const Time deadline = session.now() + least_time + count * time_for_one;
  const auto lived = session.live_until(deadline, [&] {
    const bool all_there = std::ranges::all_of(service.units(), [&](const auto& entry) {
      return service.is_there(entry.second) || entry.second.refused || entry.second.is_deaf;
    });
    return service.end() || (all_there && session.now() - service.last_request() >= quiet_time);
  });
  return lived ? session.run() : std::unexpected(lived.error());
}

} // namespace blactl::fleet
