#include "blactl/fleet/static_ids.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/fleet/allocation_service.hpp"
#include "blactl/fleet/guard.hpp"
#include "blactl/fleet/node_id_texts.hpp"
#include "blactl/fleet/texts.hpp"

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

/// Puts what is known of the units that are not there in the place of "not found".
void StaticIds::explain_absences(std::span<const IdHolder> units,
                                 std::vector<Error>& errors) const {
  auto error = errors.begin();
  for (const Wish& wish : wishes_) {
    if (std::ranges::find(units, wish.unique_id, &IdHolder::unique_id) == units.end()) {
      error = std::ranges::find(error, errors.end(), Code::not_found, &Error::code);
      *error++ = absence(wish.unique_id);
    }
  }
}

/// Everybody who told its unique ID. A unit holds its ID, and what it would get by its 0x46; one
/// for which another is wished gives that up: what its ROM holds nobody knows, so its move is not
/// spared.
std::vector<IdHolder> StaticIds::holders() const {
  std::vector<IdHolder> units;
  for (const auto& [id, member] : session_.roster().members()) {
    if (!session_.roster().heard(id) || !member.info) {
      continue;
    }
    const auto& unique_id = member.info->unique_id;
    const bool moves = std::ranges::find(wishes_, unique_id, &Wish::unique_id) != wishes_.end();
    const IdHolder unit{unique_id, id, moves ? std::nullopt : member.static_node_id};
    const auto same = std::ranges::find(units, unique_id, &IdHolder::unique_id);
    if (same == units.end()) {
      units.push_back(unit);
    } else if (session_.roster().member(same->id).last_heard < member.last_heard) {
      *same = unit; // it has moved since
    }
  }
  return units;
}

/// What those have that did not tell their unique ID, we ourselves, and units of the table.
Result<state::NodeIds> StaticIds::promised() const {
  state::NodeIds ids;
  ids.set(session_.roster().local().value());
  for (const auto& [id, member] : session_.roster().members()) {
    ids.set(id.value(), session_.roster().heard(id) && !member.info);
  }
  const auto entries = table_.entries();
  if (!entries) {
    return std::unexpected(entries.error());
  }
  for (const state::AllocationEntry& entry : *entries) {
    const bool moves =
        std::ranges::find(wishes_, entry.unique_id, &Wish::unique_id) != wishes_.end();
    if (!moves && !session_.roster().member(entry.node_id).is_unit(entry.unique_id)) {
      ids.set(entry.node_id.value());
    }
  }
  return ids;
}

std::expected<void, std::vector<Error>> StaticIds::prepare(std::span<const Wish> wishes,
                                                           bool while_driven) {
  wishes_.assign(wishes.begin(), wishes.end());
  while_driven_ = while_driven;
  const auto taken = promised();
  if (!taken) {
    return std::unexpected(std::vector{taken.error()});
  }
  const std::vector<IdHolder> units = holders();
  auto rounds = plan_id_moves(units, wishes_, *taken);
  if (!rounds) {
    explain_absences(units, rounds.error());
    return std::unexpected(std::move(rounds.error()));
  }
  rounds_ = std::move(*rounds);
  std::vector<IdMove> whole;
  for (const Wish& wish : wishes_) {
    const auto unit = std::ranges::find(units, wish.unique_id, &IdHolder::unique_id);
    whole.push_back({wish.unique_id, unit->id, wish.node_id});
    units_.push_back({.unique_id = wish.unique_id, .wish = wish.node_id, .now = unit->id});
  }
  std::ranges::sort(units_, {}, &StaticId::wish);
  auto judged = plans(whole);
  if (!judged) {
    return std::unexpected(std::move(judged.error()));
  }
  judged_ = std::move(*judged);
  if (auto errors = check(judged_); !errors.empty()) {
    return std::unexpected(std::move(errors));
  }
  return {};
}

StaticIds::Plans StaticIds::plans(std::span<const IdMove> moves) {
  std::map<NodeId, Wanted> all;
  std::vector<NodeId> nodes;
  for (const IdMove& move : moves) {
    auto one = wanted(profiles_, move.to);
    if (!one) {
      return std::unexpected(std::vector{one.error()});
    }
    nodes.push_back(move.from);
    all.insert_or_assign(move.from, std::move(*one));
  }
  auto snapshots = take_snapshots(
      session_, profiles_, nodes, manner_.identification,
      [&](const Servo& servo) { return registers_needed(all.at(servo.id), servo); },
      proof_needed(all.begin()->second));
  if (snapshots.broken) {
    return std::unexpected(std::vector{*snapshots.broken});
  }
  std::vector<Plan> plans;
  std::vector<Error> errors;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    Snapshot& snapshot = snapshots.servos[i];
    const NodeId id = moves[i].from;
    if (!snapshot.error && snapshot.servo.unique_id != moves[i].unique_id) {
      errors.push_back({Code::state, say<texts::another_servo>(id.value()),
                        say<texts::run_again_hint>(), id.value()});
      continue;
    }
    auto plan = make_plan(all.at(id), std::move(snapshot), profiles_);
    if (plan) {
      plans.push_back(std::move(*plan));
    } else {
      errors.push_back(session_.roster().is_doubled(id) ? doubled(session_.roster(), id)
                                                        : std::move(plan.error()));
    }
  }
  return errors.empty() ? Plans(std::move(plans)) : std::unexpected(std::move(errors));
}

std::vector<Error> StaticIds::check(std::span<const Plan> plans) const {
  std::vector<Error> errors;
  for (const Plan& plan : plans) {
    if (auto error = forbidden(session_.roster(), session_.now(), plan, while_driven_)) {
      errors.push_back(std::move(*error));
    }
  }
  return errors;
}

/// Who had it has left, and nobody was heard under it since.
bool StaticIds::is_free(const IdMove& move) const {
  const Member* there = session_.roster().find(move.to);
  if (move.to == move.from || there == nullptr || !session_.roster().heard(move.to)) {
    return move.to != session_.roster().local();
  }
  const auto left = left_.find(move.to);
  return left != left_.end() && there->last_heard < left->second;
}

/// Somebody may have come since the rounds were planned.
std::vector<Error> StaticIds::check(std::span<const IdMove> round) const {
  std::vector<Error> errors;
  for (const IdMove& move : round) {
    if (!is_free(move)) {
      errors.push_back({Code::duplicate_node_id,
                        say<texts::id_given_is_kept>(move.from.value(), move.to.value()),
                        say<texts::id_given_is_kept_hint>(), move.from.value()});
    }
  }
  return errors;
}

std::string StaticIds::question() const {
  return fleet::question(judged_);
}

std::vector<IdMove> StaticIds::temporary() const {
  std::vector<IdMove> moves;
  for (const auto& round : rounds_) {
    std::ranges::copy_if(round, std::back_inserter(moves), &IdMove::is_temporary);
  }
  return moves;
}

std::vector<Error> StaticIds::carry_out(const Hook& hook) {
  if (auto errors = check(judged_); !errors.empty()) {
    return errors;
  }
  if (const auto put = put_as_they_are(); !put) {
    return {put.error()};
  }
  for (const auto& round : rounds_) {
    auto errors = carry_out(round, hook);
    const bool failed = std::ranges::any_of(
        units_, [](const StaticId& unit) { return unit.last && !unit.last->is_done(); });
    if (failed || !errors.empty()) {
      return errors;
    }
  }
  return {};
}

/// An ID that a unit had when it was in the table, and has no more, is in nobody's way.
Result<void> StaticIds::put_as_they_are() {
  std::vector<Wish> entries;
  for (const StaticId& unit : units_) {
    const auto entry = table_.find(unit.unique_id);
    if (!entry) {
      return std::unexpected(entry.error());
    }
    if (*entry && (*entry)->node_id != unit.now) {
      entries.push_back({unit.unique_id, unit.now});
    }
  }
  return table_.put(entries, session_.wall());
}

std::vector<Error> StaticIds::carry_out(std::span<const IdMove> round, const Hook& hook) {
  // The table says where each will be: other allocators of this machine give it to nobody else.
  std::vector<Wish> entries;
  for (const IdMove& move : round) {
    entries.push_back({move.unique_id, move.to});
  }
  if (const auto put = table_.put(entries, session_.wall()); !put) {
    return {put.error()};
  }
  const auto plans = this->plans(round);
  if (!plans) {
    return plans.error();
  }
  auto errors = check(*plans);
  std::ranges::move(check(round), std::back_inserter(errors));
  if (!errors.empty()) {
    return errors;
  }
  auto carried_out = fleet::carry_out(session_, profiles_, *plans, manner_);
  for (std::size_t i = 0; i < round.size(); ++i) {
    conclude(round[i], std::move(carried_out.servos[i]), hook);
  }
  return carried_out.broken ? std::vector{*carried_out.broken} : std::vector<Error>();
}

void StaticIds::conclude(const IdMove& move, ChangeResult result, const Hook& hook) {
  const auto unit = std::ranges::find(units_, move.unique_id, &StaticId::unique_id);
  if (result.is_done() && result.node_id_after != move.to) {
    const std::uint8_t id = result.node_id_after.value_or(move.from).value();
    result.error = Error{Code::mismatch, say<texts::saved_and_elsewhere>(id, move.to.value()),
                         say<texts::run_again_hint>(), id};
  }
  unit->now = result.node_id_after.value_or(unit->now);
  if (result.is_done()) {
    left_[move.from] = session_.now();
    unit->is_done = !move.is_temporary;
    hook(move);
  }
  unit->last = std::move(result);
}

} // namespace blactl::fleet
