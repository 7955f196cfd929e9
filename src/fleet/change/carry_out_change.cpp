// Carries out a prepared change, looks back on it, and proves what was only believed.

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/change/history.hpp"

#include "fleet/change/goal_results.hpp"
#include "fleet/change/last_look.hpp"
#include "fleet/change/rounds.hpp"
#include "fleet/change/texts.hpp"
#include "fleet/change/unnamed.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// Whether a restart has not shown that ROM holds the goal.
bool is_unproven(const GoalResult& result, const UnitChange& unit) {
  return result.need == Need::prove && unit.is_done && unit.last &&
         !(unit.last->rom && holds(unit.last->rom->values, result.goal));
}

/// RAM is what the restart that was to prove ROM has brought back, and not what was read before.
void tell_rom(ChangeResult& change) {
  for (RegisterChange& each : change.changes) {
    const auto rom = change.rom ? bla::find(change.rom->values, each.parameter->address)
                                : std::optional<std::int64_t>();
    each.after = rom;
    each.status = !rom                     ? ChangeStatus::failed
                  : *rom != each.requested ? ChangeStatus::mismatch
                                           : ChangeStatus::unchanged;
  }
}

/// Of a unit that waits with a temporary ID, where the rounds have broken off.
Error made_way(const UnitChange& unit, NodeId before) {
  const std::uint8_t now = unit.now.value();
  if (unit.temporary_servo_id) {
    return {Code::state,
            say<texts::has_made_way_by_servo_id>(now, *unit.temporary_servo_id,
                                                 unit.saved_servo_id().value_or(0)),
            say<texts::run_again_hint>(), now};
  }
  return {Code::state,
          say<texts::has_made_way>(before.value(), now, unit.static_node_id()->value()),
          say<texts::run_again_hint>(), now};
}

} // namespace

std::vector<Error> Change::carry_out(const MoveHook& moved) {
  std::vector<Error> errors;
  go_on_with_record();
  if (!begun_.empty()) {
    errors = rounds_->carry_out(moved);
    conclude();
    const bool has_failed = std::ranges::any_of(rounds_->units(), &UnitChange::has_failed);
    if (errors.empty() && !(has_failed && options_.stops_at_failure)) {
      errors = write_what_rom_lacks();
    }
  }
  const bool is_carried_out = errors.empty() && !begun_.empty();
  if (auto lost = is_carried_out ? look_last() : Lost(); lost) {
    look_back(*lost);
  } else {
    errors.push_back(lost.error());
    look_back({});
  }
  end_record();
  look_back_once_more();
  return errors;
}

/// What came while the disk was busy with the record was not heard yet.
void Change::look_back_once_more() {
  if (session_.live_until(session_.now())) { // else nobody is heard any more
    look_back({});
  }
}

/// What has become of servos that were done before others.
Result<Change::Lost> Change::look_last() {
  const Patience patience = options_.manner.identification.patience;
  auto lost = fleet::look_last(session_, left_unchanged(), patience, LastLook::run);
  auto away = lost ? fleet::look_last(session_, proven_long_ago(), patience, LastLook::unit) : lost;
  auto other = away ? look_at_restarted() : away;
  if (!other) {
    return other;
  }
  lost->merge(*away);
  lost->merge(*other);
  return lost;
}

/// While others were changed; it is not known that their ROM holds their goals.
std::vector<Servo> Change::left_unchanged() const {
  std::vector<Servo> servos;
  for (const GoalResult& result : results_) {
    if (result.need == Need::nothing && !result.rom_proven) {
      servos.push_back(result.servo());
    }
  }
  return servos;
}

std::vector<Servo> Change::proven_long_ago() const {
  std::vector<Servo> servos;
  for (const GoalResult& result : results_) {
    const bool is_unchanged = result.need == Need::nothing;
    const Time last = is_unchanged ? result.servo().since : result.change.looked_at;
    const auto id = is_unchanged ? std::optional(result.servo().id) : result.change.node_id_after;
    const bool is_proven = result.is_done ? result.rom_proven.value_or(false) : result.change.saved;
    if (is_proven && id && last < session_.now() - long_ago) {
      servos.push_back(result.servo());
      servos.back().id = *id;
    }
  }
  return servos;
}

/// Of a servo whose ROM is proven: since that proof, as far as heard.
bool Change::has_restarted_since(const GoalResult& result) const {
  const bool is_unchanged = result.need == Need::nothing;
  const auto id = is_unchanged ? std::optional(result.servo().id) : result.change.node_id_after;
  if (!result.is_done || !result.rom_proven.value_or(false) || !id) {
    return false;
  }
  return is_unchanged
             ? may_have_restarted(session_.roster(), *id, result.servo().boot, dronecan::Health::ok)
             : may_have_restarted(session_.roster(), *id, result.change.boots,
                                  result.change.health);
}

/// They may not have been able to read their ROM, or have another.
Result<Change::Lost> Change::look_at_restarted() {
  std::vector<std::size_t> goals;
  for (std::size_t i = 0; i < results_.size(); ++i) {
    GoalResult& result = results_[i];
    if (has_restarted_since(result)) {
      result.goal.id = result.change.node_id_after.value_or(result.goal.id);
      goals.push_back(i);
    }
  }
  const auto read = this->read(goals);
  if (!read) {
    return std::unexpected(read.error());
  }
  Lost lost;
  std::vector<dronecan::UniqueId> doubtful;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const Snapshot& held = (*read)[i];
    const Goal& goal = results_[goals[i]].goal;
    const GoalResult& result = results_[goals[i]];
    auto why = refuse(goal, held);
    why = why ? why : check_rom(held);
    why = why ? why
              : unproven_since(session_.roster(), goal.id,
                               result.need == Need::nothing ? result.servo().boot
                                                            : result.change.boots);
    if (!why && !holds(held.values(), goal)) {
      const std::uint8_t id = goal.id.value();
      why = Error{Code::state, say<texts::lost_since>(id), say<texts::run_again_hint>(), id};
    }
    if (why) {
      lost.emplace(goal.id, std::move(*why));
      doubtful.push_back(*results_[goals[i]].servo().unique_id);
    }
  }
  const auto doubted = options_.manner.history != nullptr
                           ? options_.manner.history->doubt_rom(doubtful)
                           : Result<void>();
  return doubted ? Result<Lost>(std::move(lost)) : std::unexpected(doubted.error());
}

/// Checks that servos left unchanged still hold their goals, as far as heard.
void Change::look_back(const Lost& lost) {
  for (GoalResult& result : results_) {
    if (result.need != Need::nothing) {
      look_back(result, lost); // of one round; its own job has checked the rest
      continue;
    }
    if (auto why = result.errors.empty() ? lost_unchanged(result, lost) : std::nullopt) {
      result.errors.push_back(std::move(*why));
    }
    result.is_done = result.errors.empty();
    if (!result.is_done) {
      result.change.doubt();
    }
  }
}

/// Why a servo that was left unchanged may not hold its goal any more.
std::optional<Error> Change::lost_unchanged(const GoalResult& result, const Lost& lost) const {
  const Roster& roster = session_.roster();
  const Servo& servo = result.servo();
  const std::uint8_t id = servo.id.value();
  const bool restarted = roster.member(servo.id).boots != servo.boot;
  if (roster.is_doubled(servo.id)) {
    return doubled(roster, servo.id);
  }
  if (const auto writer = result.rom_proven ? roster.setter_of(servo.id, servo.since)
                                            : roster.writer_to(servo.id, servo.since)) {
    return Error{Code::state, say<texts::written_by_other>(id, writer->value()),
                 say<texts::other_writer_hint>(), id};
  }
  if (restarted && !result.rom_proven) { // RAM was reloaded from ROM
    return Error{Code::state, say<texts::lost_since>(id), say<texts::run_again_hint>(), id};
  }
  const auto found = lost.find(servo.id);
  return found != lost.end() ? std::optional(found->second) : std::nullopt;
}

/// Later rounds may have taken long: another unit, or another node's write, may have come since.
void Change::look_back(GoalResult& result, const Lost& lost) const {
  const Roster& roster = session_.roster();
  const auto id = result.change.node_id_after;
  if (!id) {
    return;
  }
  if (!result.is_done) {
    look_back_at_failed(result, *id, lost);
    return;
  }
  const Time since = result.change.looked_at;
  const bool is_in_ram_only = result.change.was_sent && !result.change.may_have_saved;
  if (roster.is_doubled(*id)) {
    result.errors.push_back(doubled(roster, *id));
  } else if (const auto saver = is_in_ram_only ? roster.saver_of(*id, since) : std::nullopt) {
    result.errors.push_back({Code::state, say<texts::saved_by_other>(id->value(), saver->value()),
                             say<texts::run_again_hint>(), id->value()});
    result.change.doubt();
  } else if (is_in_ram_only && roster.member(*id).boots != result.change.boots) {
    result.errors.push_back({Code::state, say<texts::lost_since>(id->value()),
                             say<texts::run_again_hint>(), id->value()});
    result.change.doubt();
  } else if (const auto by =
                 is_in_ram_only ? roster.writer_to(*id, since) : roster.setter_of(*id, since)) {
    result.errors.push_back({Code::state, say<texts::written_by_other>(id->value(), by->value()),
                             say<texts::other_writer_hint>(), id->value()});
    result.change.doubt();
  } else if (const auto found = lost.find(*id); found != lost.end()) {
    result.errors.push_back(found->second);
    result.change.doubt();
  } else {
    return;
  }
  result.is_done = result.change.saved = result.change.is_verified = false;
  result.rom_proven = result.rom_proven ? std::optional(false) : std::nullopt;
}

/// One that has made way and waited for others on a temporary ID, or has waited in vain for its
/// turn: what it held at its last look it may have lost.
void Change::look_back_at_failed(GoalResult& result, NodeId id, const Lost& lost) const {
  const Roster& roster = session_.roster();
  const ChangeResult& last = result.change;
  const std::uint32_t boots = last.was_begun ? last.boots : result.servo().boot;
  const Time since = last.was_begun ? last.looked_at : result.servo().since;
  if (may_have_restarted(roster, id, boots, last.health) || roster.setter_of(id, since) ||
      lost.contains(id)) {
    result.change.doubt();
    result.change.saved = false;
  }
}

void Change::conclude() {
  for (std::size_t i = 0; i < begun_.size(); ++i) {
    conclude(rounds_->units()[i], results_[begun_[i]]);
  }
}

void Change::conclude(const UnitChange& unit, GoalResult& result) {
  const bool is_lacking = is_unproven(result, unit);
  result.is_done = unit.is_done && !is_lacking;
  if (!unit.last) {
    return;
  }
  const ChangeResult& last = *unit.last;
  result.change = merged(std::move(result.change), last);
  result.errors = result.change.errors();
  const bool waits = unit.has_made_way || unit.temporary_servo_id;
  if (waits && (last.is_done() || !last.may_have_saved)) {
    result.errors.push_back(made_way(unit, result.goal.id));
  }
  if (is_lacking) {
    tell_rom(result.change);
  }
  if (is_lacking && !last.rom) {
    const std::uint8_t id = last.servo.id.value();
    result.errors.push_back(
        {Code::state, say<texts::restarts_while_read>(id), say<texts::restarts_again_hint>(), id});
  }
  result.rom_proven = result.goal.saves() ? std::optional(result.is_done) : std::nullopt;
  if (result.need == Need::prove && last.rom) {
    result.change.warnings =
        unnamed(result.goal, unit.plan.before, {last.rom->values, true}, result.need, true);
    std::ranges::move(losses(last.warnings), std::back_inserter(result.change.warnings));
  }
}

/// Writes goals that a restart has shown to be missing in ROM.
std::vector<Error> Change::write_what_rom_lacks() {
  std::vector<std::size_t> lacking;
  for (std::size_t i = 0; i < begun_.size(); ++i) {
    GoalResult& result = results_[begun_[i]];
    if (is_unproven(result, rounds_->units()[i])) {
      result.goal.id = result.change.node_id_after.value_or(result.goal.id);
      lacking.push_back(begun_[i]);
    }
  }
  if (lacking.empty()) {
    return {};
  }
  auto errors = prepare(lacking);
  if (!errors.empty()) {
    return refusals_after_restart(std::move(errors));
  }
  if (!begun_.empty()) {
    errors = rounds_->carry_out({});
    conclude();
  }
  return errors;
}

/// What ROM has brought back forbids the goal: the state is in the way, the user has made no
/// mistake. Those of one servo are in its result; the others are returned.
std::vector<Error> Change::refusals_after_restart(std::vector<Error> errors) {
  constexpr int refused_before_anything_was_sent = 2; // contract, section 3
  const auto settle = [](Error& error) {
    if (exit_status(error.code) == refused_before_anything_was_sent) {
      error.code = Code::state;
    }
  };
  for (GoalResult& result : results_) {
    std::ranges::for_each(result.errors, settle);
    std::erase_if(errors, [&](const Error& error) {
      return std::ranges::find(result.errors, error.message, &Error::message) !=
             result.errors.end();
    });
  }
  std::ranges::for_each(errors, settle);
  return errors;
}

/// Servos that an earlier try has done need nothing now, but are part of the change.
void Change::go_on_with_record() {
  std::vector<Servo> units;
  for (const GoalResult& result : results_) {
    if (result.goal.saves() && result.servo().unique_id) {
      units.push_back(result.servo());
    }
  }
  if (options_.manner.history != nullptr) { // on failure the record itself will tell
    [[maybe_unused]] const auto found = options_.manner.history->go_on(units, session_.wall());
  }
}

/// A completed change is not continued when the command is repeated.
void Change::end_record() {
  std::vector<dronecan::UniqueId> units;
  for (const GoalResult& result : results_) {
    if (result.is_done && result.servo().unique_id) {
      units.push_back(*result.servo().unique_id);
    }
  }
  const Manner& manner = options_.manner;
  const bool are_all = std::ranges::all_of(results_, &GoalResult::is_done);
  const auto ended =
      manner.history != nullptr ? manner.history->end(units, are_all) : Result<void>();
  if (!ended && manner.end_not_recorded) {
    manner.end_not_recorded(ended.error());
  }
}

} // namespace blactl::fleet
