#include "blactl/fleet/change/static_ids.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/fleet/bus/snapshots.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/fleet/change/restart_texts.hpp"

#include "fleet/change/id_holders.hpp"
#include "fleet/change/node_id_texts.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace blactl::fleet {

using dronecan::NodeId;
using dronecan::UniqueId;

namespace {

using namespace std::chrono_literals;

/// For a unit to get an ID and to be heard under it: allocation takes about 1 s, one after the
/// other.
constexpr Duration least_time_to_let_in = 5s;
constexpr Duration time_to_let_in = 2s;

/// 0x46 written, and saved.
Result<Wanted> wanted(const bla::Profiles& profiles, NodeId id) {
  auto assignment = bla::make_assignment(profiles, bla::address::static_node_id.name(),
                                         std::to_string(id.value()));
  if (!assignment) {
    return std::unexpected(assignment.error());
  }
  return Wanted{.assignments = {std::move(*assignment)}, .restart = RestartKind::save};
}

} // namespace

Result<std::vector<StaticIds::Wish>> StaticIds::as_they_are(std::span<const NodeId> nodes) const {
  std::vector<Wish> wishes;
  for (const NodeId id : nodes) {
    const Member member = session_.roster().member(id);
    if (session_.roster().is_doubled(id)) {
      return std::unexpected(doubled(session_.roster(), id));
    }
    if (!member.info) {
      return std::unexpected(silent(session_.roster(), id));
    }
    wishes.push_back({member.info->unique_id, id});
  }
  return wishes;
}

bool StaticIds::is_there(const UniqueId& unique_id) const {
  return std::ranges::any_of(session_.roster().members(), [&](const auto& entry) {
    return entry.second.is_unit(unique_id) && session_.roster().heard(entry.first);
  });
}

Result<void> StaticIds::let_in(std::span<const Wish> wishes) {
  std::vector<Wish> missing;
  std::ranges::copy_if(wishes, std::back_inserter(missing),
                       [this](const Wish& wish) { return !is_there(wish.unique_id); });
  // Who asks may be one of them: requests collide, and not all of them are heard.
  const Roster& roster = session_.roster();
  if (missing.empty() || roster.pending().empty() || !manner_.may_allocate ||
      !roster.allocators().empty()) {
    return {};
  }
  for (const Wish& wish : missing) {
    const auto id = table_.assign(
        wish.unique_id, {.preferred = wish.node_id, .taken = roster.ids_in_use(wish.unique_id)},
        session_.wall());
    if (!id) {
      return std::unexpected(id.error());
    }
  }
  // Nobody else gets an ID from it: whoever is not in the table waits until the bus is known.
  const AllocationService service(session_, table_, {}, [](auto, const auto&) {});
  const auto count = static_cast<Duration::rep>(missing.size());
  const Time deadline = session_.now() + least_time_to_let_in + count * time_to_let_in;
  const auto lived = session_.live_until(deadline, [&] {
    return std::ranges::all_of(missing,
                               [this](const Wish& wish) { return is_there(wish.unique_id); });
  });
  if (!lived) {
    return std::unexpected(lived.error());
  }
  for (const auto& [unique_id, unit] : service.units()) {
    if (unit.node_id.is_unicast() && !is_there(unique_id)) {
      not_let_in_.emplace(unique_id, service.refusal(unit).value_or(service.absence(unit)));
    }
  }
  return session_.run();
}

/// Why a unit is not among those whose node ID is known.
Error StaticIds::absence(const UniqueId& unique_id) const {
  const Roster& roster = session_.roster();
  for (const NodeId id : roster.doubled()) {
    const auto units = roster.units(id); // where none told who it is, it may be one of those
    if (units.empty() || units.contains(unique_id)) {
      return doubled(roster, id);
    }
  }
  if (const auto known = not_let_in_.find(unique_id); known != not_let_in_.end()) {
    return known->second;
  }
  const std::string named = "uid:" + hex(unique_id);
  return roster.is_pending(unique_id)
             ? Error{Code::not_found, say<texts::target_waits_for_id>(named),
                     say<texts::target_waits_for_id_hint>(), std::nullopt}
             : Error{Code::not_found, say<texts::nothing_matches>(named),
                     say<texts::node_not_found_hint>(), std::nullopt};
}

/// What is against the wishes, whatever the servos hold. What is known of the units that are not
/// there takes the place of "not found".
std::vector<Error> StaticIds::judge(std::span<const Wish> wishes) const {
  const auto taken = promised(session_.roster(), table_, wishes);
  if (!taken) {
    return {taken.error()};
  }
  const std::vector<IdHolder> units = holders(session_.roster(), wishes);
  const auto rounds = plan_id_moves(units, wishes, *taken);
  auto errors = rounds ? std::vector<Error>() : rounds.error();
  auto error = errors.begin();
  for (const Wish& wish : wishes) {
    if (std::ranges::find(units, wish.unique_id, &IdHolder::unique_id) == units.end()) {
      error = std::ranges::find(error, errors.end(), Code::not_found, &Error::code);
      *error++ = absence(wish.unique_id);
    }
  }
  return errors;
}

StaticIds::Tasks StaticIds::read(std::span<const Wish> wishes) {
  const std::vector<IdHolder> units = holders(session_.roster(), wishes);
  std::map<NodeId, Wanted> all;
  std::vector<NodeId> nodes;
  for (const Wish& wish : wishes) {
    auto one = wanted(profiles_, wish.node_id);
    if (!one) {
      return std::unexpected(std::vector{one.error()});
    }
    nodes.push_back(std::ranges::find(units, wish.unique_id, &IdHolder::unique_id)->id);
    all.insert_or_assign(nodes.back(), std::move(*one));
  }
  auto snapshots = take_snapshots(
      session_, profiles_, nodes, manner_.identification,
      [&](const Servo& servo) { return registers_needed(all.at(servo.id), servo); },
      proof_needed(all.begin()->second));
  if (snapshots.broken) {
    return std::unexpected(std::vector{*snapshots.broken});
  }
  std::vector<UnitTask> tasks;
  std::vector<Error> errors;
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    Snapshot& snapshot = snapshots.servos[i];
    const NodeId id = nodes[i];
    if (!snapshot.error && snapshot.servo.unique_id != wishes[i].unique_id) {
      errors.push_back({Code::state, say<texts::another_servo>(id.value()),
                        say<texts::run_again_hint>(), id.value()});
    }
    tasks.push_back({std::move(snapshot), std::move(all.at(id))});
  }
  return errors.empty() ? Tasks(std::move(tasks)) : std::unexpected(std::move(errors));
}

std::vector<Error> StaticIds::prepare(std::span<const Wish> wishes) {
  if (auto errors = judge(wishes); !errors.empty()) {
    return errors;
  }
  std::vector<Wish> sorted(wishes.begin(), wishes.end());
  std::ranges::sort(sorted, {}, &Wish::node_id);
  auto tasks = read(sorted);
  return tasks ? change_.prepare(std::move(*tasks)) : std::move(tasks.error());
}

} // namespace blactl::fleet
