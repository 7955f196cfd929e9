#include "blactl/fleet/change/let_in.hpp"

#include "blactl/fleet/change/allocation_service.hpp"

#include "fleet/change/id_holders.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <vector>

namespace blactl::fleet {
namespace {

using namespace std::chrono_literals;

/// For a unit to get an ID and to be heard under it: allocation takes about 1 s, one unit after the
/// other.
constexpr Duration least_time = 5s;
constexpr Duration time_for_one = 2s;

/// After this time without a request no unit asks any more, even if one was lost
/// (1.Allocation.uavcan).
constexpr Duration quiet_time = 3s;

Time deadline(const Session& session, std::size_t units) {
  return session.now() + least_time + static_cast<Duration::rep>(units) * time_for_one;
}

} // namespace

Result<void> let_in(Session& session, state::AllocationStore& table) {
  if (!session.roster().allocators().empty()) {
    return {}; // another allocator does it
  }
  AllocationService service(session, table, {}, [](auto, const auto&) {});
  service.bus_is_known();
  const Time end = deadline(session, session.roster().pending().size());
  const auto lived = session.live_until(end, [&] {
    const bool all_there = std::ranges::all_of(service.units(), [&](const auto& entry) {
      return service.is_there(entry.second) || entry.second.refused || entry.second.is_deaf;
    });
    return service.end() || (all_there && session.now() - service.last_request() >= quiet_time);
  });
  return lived ? session.run() : std::unexpected(lived.error());
}

Result<NotLetIn> let_in(Session& session, state::AllocationStore& table,
                        std::span<const state::AllocationStore::Wish> wishes) {
  using Wish = state::AllocationStore::Wish;
  const Roster& roster = session.roster();
  const auto is_missing = [&](const Wish& wish) { return !is_here(roster, wish.unique_id); };
  std::vector<Wish> missing;
  std::ranges::copy_if(wishes, std::back_inserter(missing), is_missing);
  // a unit that asks may be one of them: requests collide, and not all of them are heard
  if (missing.empty() || roster.pending().empty() || !roster.allocators().empty()) {
    return {};
  }
  for (const Wish& wish : missing) {
    const auto id = allocate(session, table, wish.unique_id, {.preferred = wish.node_id});
    if (!id) {
      return std::unexpected(id.error());
    }
  }
  // no other unit gets an ID from it: those not in the table wait until the bus is known
  const AllocationService service(session, table, {}, [](auto, const auto&) {});
  const auto lived = session.live_until(deadline(session, missing.size()),
                                        [&] { return std::ranges::none_of(missing, is_missing); });
  if (!lived) {
    return std::unexpected(lived.error());
  }
  NotLetIn left;
  for (const auto& [unique_id, unit] : service.units()) {
    if (unit.node_id.is_unicast() && !is_here(roster, unique_id)) {
      left.emplace(unique_id, service.refusal(unit).value_or(service.absence(unit)));
    }
  }
  const auto ran = session.run();
  return ran ? Result<NotLetIn>(std::move(left)) : std::unexpected(ran.error());
}

} // namespace blactl::fleet
