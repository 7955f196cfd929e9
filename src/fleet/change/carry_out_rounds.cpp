// Carries planned rounds out, one after the other: in each, all servos whose node ID is free.

#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/guard.hpp"

#include "fleet/change/id_holders.hpp"
#include "fleet/change/id_texts.hpp"
#include "fleet/change/rounds.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

using Wish = state::AllocationStore::Wish;

/// Of a unit that failed: the static ID that its ROM may hold, for its next start; empty: it does
/// not, or the unit has told since its start which one it has.
std::optional<NodeId> next_id(const UnitChange& unit) {
  if (!unit.has_failed() || !unit.last || !unit.last->may_have_saved) {
    return std::nullopt;
  }
  const bool is_rom_told = unit.last->returned && !unit.last->is_rom_unread;
  const auto change =
      std::ranges::find(unit.last->changes, bla::address::static_node_id,
                        [](const RegisterChange& each) { return each.parameter->address; });
  if (change == unit.last->changes.end()) {
    return is_rom_told ? std::nullopt : unit.static_node_id(); // RAM held it before
  }
  const bool is_told = is_rom_told && change->after;
  return !is_told && change->requested > 0 && change->requested <= NodeId::max
             ? std::optional(NodeId(static_cast<std::uint8_t>(change->requested)))
             : std::nullopt;
}

/// A unit that failed, and whose memory may hold this ID for its next start.
bool may_start_with(const UnitChange& unit, NodeId id) {
  const bool held_it =
      !unit.has_made_way && unit.plan.before.raw(bla::address::static_node_id) == id.value();
  return unit.has_failed() && (held_it || next_id(unit) == id);
}

} // namespace

std::vector<Error> Rounds::carry_out(const Hook& hook) {
  if (auto errors = check(); !errors.empty()) {
    return errors;
  }
  const std::vector<Plan> plans = this->plans();
  auto refused = record(session_, plans, options_.manner);
  auto errors = refused ? std::vector{std::move(*refused)} : carry_out_rounds(hook);
  std::vector<ChangeResult> never_begun;
  std::ranges::transform(plans, std::back_inserter(never_begun), as_planned);
  record_end(session_, never_begun, options_.manner);
  return errors;
}

/// The table ends with the IDs that the servos have, also where they did not take what was
/// promised.
std::vector<Error> Rounds::carry_out_rounds(const Hook& hook) {
  if (const auto put = put_as_they_are(); !put) {
    return {put.error()};
  }
  auto errors = carry_out_each(hook);
  const bool has_failed = !errors.empty() || std::ranges::any_of(units_, &UnitChange::has_failed);
  auto put = has_failed ? put_as_they_are() : Result<void>();
  put = put && has_failed ? give_back() : put;
  if (!put) {
    errors.push_back(put.error());
  }
  return errors;
}

/// IDs that were to be taken over from units that are away, and were not, are theirs again.
Result<void> Rounds::give_back() {
  std::vector<Wish> entries;
  for (const state::AllocationEntry& former : absent_) {
    const auto unit =
        std::ranges::find(units_, std::optional(former.node_id), &UnitChange::static_node_id);
    const bool stays =
        unit != units_.end() && unit->now != former.node_id && next_id(*unit) != former.node_id;
    if (stays) {
      entries.push_back({former.unique_id, former.node_id});
    }
  }
  return entries.empty()
             ? Result<void>()
             : table_->enter(entries, session_.wall(), state::AllocationStore::Former::keeps);
}

std::vector<Error> Rounds::carry_out_each(const Hook& hook) {
  for (const Round& round : rounds_) {
    auto errors = carry_out(round, hook);
    const bool stops =
        options_.stops_at_failure && std::ranges::any_of(units_, &UnitChange::has_failed);
    if (stops || !errors.empty()) {
      return errors;
    }
  }
  return {};
}

/// The present place of a unit in the table, or that of its next start if ROM may hold it; empty:
/// no better one is known.
std::optional<NodeId> Rounds::place(const dronecan::UniqueId& unique_id) const {
  const auto unit = std::ranges::find(units_, unique_id, &UnitChange::unique_id);
  if (unit == units_.end() || !unit->static_node_id()) {
    return static_place(session_.roster(), unique_id);
  }
  const auto next = next_id(*unit);
  return next ? next : unit->now;
}

/// Removes IDs in the table that their units do not have any more. If no IDs are assigned the table
/// stays unchanged.
Result<void> Rounds::put_as_they_are() {
  if (std::ranges::none_of(
          units_, [](const UnitChange& unit) { return unit.static_node_id().has_value(); })) {
    return {};
  }
  const auto known = table_->entries();
  if (!known) {
    return std::unexpected(known.error());
  }
  std::vector<Wish> entries;
  for (const state::AllocationEntry& entry : *known) {
    const auto now = place(entry.unique_id);
    if (now && *now != entry.node_id) {
      entries.push_back({entry.unique_id, *now});
    }
  }
  return table_->enter(entries, session_.wall(), state::AllocationStore::Former::yields);
}

/// Enters the future IDs into the table, so that other allocators of this machine do not assign
/// them.
Result<void> Rounds::put(const Round& round) {
  std::vector<Wish> entries;
  for (const Step& step : round) {
    if (step.move) {
      entries.push_back({step.move->unique_id, step.move->to});
    }
  }
  return entries.empty()
             ? Result<void>()
             : table_->enter(entries, session_.wall(), state::AllocationStore::Former::yields);
}

/// Its previous holder has left, no unit was heard under it since, and none that failed may start
/// with it.
bool Rounds::is_free(const IdMove& move) const {
  const bool is_in_memory = std::ranges::any_of(units_, [&](const UnitChange& unit) {
    return unit.unique_id != move.unique_id && may_start_with(unit, move.to);
  });
  if (is_in_memory) {
    return false;
  }
  const Member* there = session_.roster().find(move.to);
  if (move.to == move.from || there == nullptr || !session_.roster().heard(move.to)) {
    return move.to != session_.roster().local();
  }
  const auto left = left_.find(move.to);
  return left != left_.end() && there->last_heard < left->second;
}

/// Why an ID is not free: a servo of this change did not leave it, or another node has it.
Error Rounds::why_not_free(const IdMove& move) const {
  const std::uint8_t from = move.from.value(), to = move.to.value();
  const bool is_ours = std::ranges::any_of(units_, [&](const UnitChange& unit) {
    return unit.unique_id != move.unique_id && unit.has_failed() &&
           (unit.plan.before.servo.id == move.to || may_start_with(unit, move.to));
  });
  if (!is_ours) {
    return {Code::duplicate_node_id, say<texts::id_given_is_kept>(from, to),
            say<texts::id_given_is_kept_hint>(), from};
  }
  const auto unit = std::ranges::find(units_, move.unique_id, &UnitChange::unique_id);
  return {Code::state,
          unit->has_made_way ? say<texts::stays_out_of_the_way>(from, to)
                             : say<texts::id_is_not_left>(from, to),
          say<texts::run_again_hint>(), from};
}

/// The steps of the round that can go on: without a failure, and with a free ID.
Rounds::Round Rounds::ready(const Round& round) {
  Round steps;
  for (const Step& step : round) {
    if (units_[step.unit].has_failed()) {
      continue;
    }
    if (step.move && !is_free(*step.move)) {
      fail(step, why_not_free(*step.move));
      continue;
    }
    if (auto taken = servo_id_not_free(step)) {
      fail(step, std::move(*taken));
      continue;
    }
    steps.push_back(step);
  }
  return steps;
}

/// The present values of those that have moved before. They were saved and restarted: RAM equals
/// ROM, also after a restart that was not heard.
Result<Rounds::Sights> Rounds::look_again(const Round& steps) {
  std::map<NodeId, std::pair<std::size_t, Wanted>> moved;
  std::vector<NodeId> nodes;
  for (const Step& step : steps) {
    const UnitChange& unit = units_[step.unit];
    if (unit.last) {
      nodes.push_back(unit.now);
      moved.insert_or_assign(unit.now, std::pair(step.unit, unit.wanted));
    }
  }
  if (nodes.empty()) {
    return {};
  }
  auto read = take_snapshots(
      session_, profiles_, nodes, options_.manner.identification,
      [&](const Servo& servo) { return registers_needed(moved.at(servo.id).second, servo); },
      ReadJob::Proof::unit);
  if (read.broken) {
    return std::unexpected(*read.broken);
  }
  Sights sights;
  for (Snapshot& snapshot : read.servos) {
    const std::size_t unit = moved.at(snapshot.servo.id).first;
    sights.insert_or_assign(unit, std::move(snapshot));
  }
  return sights;
}

/// Between its two saves somebody else may have changed what it holds: SAVE would make that
/// permanent.
std::optional<Error> Rounds::changed_since(const UnitChange& unit, const Snapshot& before) const {
  const bool is_as_saved =
      before.error || !unit.last->rom || !compare(before, unit.last->rom->values);
  if (is_as_saved) {
    return std::nullopt;
  }
  const std::uint8_t id = unit.now.value();
  const auto writer = session_.roster().setter_of(unit.now, unit.last->looked_at);
  return Error{Code::state,
               writer ? say<texts::written_by_other>(id, writer->value())
                      : say<texts::changed_before_save>(id),
               writer ? say<texts::other_writer_hint>() : say<texts::run_again_hint>(), id};
}

/// The plan as made; a new one for a servo that makes way for others, or has done so.
Result<Plan> Rounds::plan(const Step& step, const Sights& sights) {
  const UnitChange& unit = units_[step.unit];
  const bool makes_way = step.temporary_servo_id || (step.move && step.move->is_temporary);
  if (!makes_way && !unit.last) {
    return unit.plan;
  }
  const auto wanted = this->wanted(step);
  if (!wanted) {
    return std::unexpected(wanted.error());
  }
  const auto sight = sights.find(step.unit);
  if (sight == sights.end()) {
    return make_plan(*wanted, unit.plan.before, profiles_);
  }
  const Snapshot& before = sight->second;
  if (!before.error && before.servo.unique_id != unit.unique_id) {
    return std::unexpected(Error{Code::state, say<texts::another_servo>(unit.now.value()),
                                 say<texts::run_again_hint>(), unit.now.value()});
  }
  if (auto error = changed_since(unit, before)) {
    ChangeResult& last = *units_[step.unit].last;
    last.doubt();
    last.saved = false;
    return std::unexpected(std::move(*error));
  }
  auto plan = make_plan(*wanted, before, profiles_);
  if (plan) {
    if (auto error =
            forbidden(session_.roster(), session_.now(), *plan, options_.manner.while_driven)) {
      return std::unexpected(std::move(*error));
    }
  }
  return plan;
}

std::vector<Error> Rounds::carry_out(const Round& round, const Hook& hook) {
  Round steps;
  std::vector<Plan> plans;
  const Round begun = ready(round);
  const auto sights = look_again(begun);
  if (!sights) {
    return {sights.error()};
  }
  for (const Step& step : ready(begun)) { // somebody may have come while they were looked at
    auto planned = plan(step, *sights);
    if (planned) {
      steps.push_back(step);
      plans.push_back(std::move(*planned));
    } else {
      fail(step, std::move(planned.error()));
    }
  }
  if (options_.stops_at_failure && std::ranges::any_of(units_, &UnitChange::has_failed)) {
    return {};
  }
  if (const auto kept = put(steps); !kept) {
    return {kept.error()};
  }
  for (const Step& step : steps) {
    if (const auto given = servo_id_of(step)) {
      units_[step.unit].servo_ids.insert(*given);
    }
  }
  auto carried_out = fleet::carry_out(session_, profiles_, plans, options_.manner);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    conclude(steps[i], std::move(carried_out.servos[i]), hook);
  }
  return carried_out.broken ? std::vector{*carried_out.broken} : std::vector<Error>();
}

/// Why the unit of a move is not where it should be; empty: it is. Another allocator may give a
/// dynamic one any other ID.
std::optional<Error> Rounds::misplaced(const IdMove& move, const ChangeResult& result) {
  const bool is_there =
      move.is_dynamic ? result.node_id_after != move.from : result.node_id_after == move.to;
  if (is_there) {
    return std::nullopt;
  }
  const std::uint8_t id = result.node_id_after.value_or(move.from).value();
  return Error{Code::mismatch,
               move.is_dynamic ? say<texts::asked_and_elsewhere>(id)
                               : say<texts::saved_and_elsewhere>(id, move.to.value()),
               say<texts::run_again_hint>(), id};
}

void Rounds::conclude(const Step& step, ChangeResult result, const Hook& hook) {
  UnitChange& unit = units_[step.unit];
  if (step.move && result.is_done()) {
    result.error = misplaced(*step.move, result);
  }
  unit.now = result.node_id_after.value_or(unit.now);
  const auto earlier = unit.last ? unit.last->warnings : std::vector<Warning>();
  for (const Warning& warning : earlier) { // of the round in which it made way
    if (std::ranges::find(result.warnings, warning.text, &Warning::text) == result.warnings.end()) {
      result.warnings.push_back(warning);
    }
  }
  unit.last = std::move(result);
  if (!unit.last->is_done()) {
    return;
  }
  unit.has_made_way = step.move && step.move->is_temporary;
  unit.temporary_servo_id = step.temporary_servo_id;
  unit.is_done = !unit.has_made_way && !unit.temporary_servo_id;
  if (unit.plan.restart == RestartKind::save) { // what ROM holds is proven
    const auto given = servo_id_of(step);
    unit.servo_ids = given ? std::set{*given} : std::set<std::int64_t>();
  }
  if (step.move) {
    // its start on the new ID: what is heard on the old one later is another's
    const auto started = session_.roster().started(unit.now);
    left_[step.move->from] = std::min(session_.now(), started.value_or(session_.now()));
    if (hook) {
      hook(*step.move);
    }
  }
}

/// It was not its turn yet, or is not any more.
void Rounds::fail(const Step& step, Error error) {
  UnitChange& unit = units_[step.unit];
  ChangeResult result = unit.last ? *unit.last : as_planned(unit.plan);
  result.is_verified = false;
  result.error = std::move(error);
  unit.last = std::move(result);
}

} // namespace blactl::fleet
