#include "blactl/fleet/change/let_in.hpp"

#include "fleet/change/id_holders.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <ranges>
#include <utility>

namespace blactl::fleet {

using dronecan::UniqueId;

namespace {

using namespace std::chrono_literals;

/// For a unit to get an ID and to be heard under it: allocation takes about 1 s, one unit after the
/// other.
constexpr Duration least_time = 5s;
constexpr Duration time_for_one = 2s;

/// With many units requests collide; none gets an ID for so long only where none will.
constexpr Duration longest_wait_for_one = 9s;

/// After this time without a request no unit asks any more, even if one was lost
/// (1.Allocation.uavcan).
constexpr Duration quiet_time = 3s;

Time deadline(const Session& session, std::size_t units) {
  return session.now() + least_time + static_cast<Duration::rep>(units) * time_for_one;
}

} // namespace

Result<std::vector<AllocatedUnit>> let_in(Session& session, state::AllocationStore& table,
                                          std::optional<std::vector<UniqueId>> units,
                                          const state::NodeIds& avoided) {
  if (!session.roster().allocators().empty()) {
    return {}; // another allocator does it
  }
  using Event = AllocationService::Event;
  Time progress = session.now();
  AllocationService service(session, table, {}, [&](Event event, const AllocatedUnit& /*unit*/) {
    progress = event == Event::assigned || event == Event::kept ? session.now() : progress;
  });
  service.bus_is_known();
  service.avoid(avoided);
  if (units) {
    service.serve_only(std::move(*units));
  }
  const auto is_over = [&] {
    const bool all_there = std::ranges::all_of(service.units(), [&](const auto& entry) {
      return service.is_there(entry.second) || entry.second.refused || entry.second.is_deaf;
    });
    return service.end() || (all_there && session.now() - service.last_request() >= quiet_time);
  };
  while (!is_over() && session.now() < progress + longest_wait_for_one) {
    if (const auto lived = session.live_until(progress + longest_wait_for_one, is_over); !lived) {
      return std::unexpected(lived.error());
    }
  }
  std::vector<AllocatedUnit> asked;
  std::ranges::copy(service.units() | std::views::values, std::back_inserter(asked));
  const auto ran = session.run();
  return ran ? Result<std::vector<AllocatedUnit>>(std::move(asked)) : std::unexpected(ran.error());
}

Result<LetIn> let_in(Session& session, state::AllocationStore& table,
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
  LetIn done;
  for (const Wish& wish : missing) {
    const auto given = allocate(session, table, wish.unique_id, {.preferred = wish.node_id});
    if (!given) {
      return std::unexpected(given.error());
    }
    if (given->is_new) {
      done.allocated.push_back({.unique_id = wish.unique_id,
                                .node_id = given->node_id,
                                .is_new = true,
                                .former = given->former});
    }
  }
  // no other unit gets an ID from it: those not in the table wait until the bus is known
  const AllocationService service(session, table, {}, [](auto, const auto&) {});
  const auto lived = session.live_until(deadline(session, missing.size()),
                                        [&] { return std::ranges::none_of(missing, is_missing); });
  if (!lived) {
    return std::unexpected(lived.error());
  }
  for (const auto& [unique_id, unit] : service.units()) {
    if (unit.node_id.is_unicast() && !is_here(roster, unique_id)) {
      done.left.emplace(unique_id, service.refusal(unit).value_or(service.absence(unit)));
    }
  }
  const auto ran = session.run();
  return ran ? Result<LetIn>(std::move(done)) : std::unexpected(ran.error());
}

} // namespace blactl::fleet
