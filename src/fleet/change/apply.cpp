#include "blactl/fleet/change/apply.hpp"

#include "blactl/fleet/bus/snapshots.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/restart_texts.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>

namespace blactl::fleet {

using bla::Assignment;
using dronecan::NodeId;

namespace {

Wanted wanted(const Goal& goal, Need need) {
  if (need == Need::prove) {
    return {.restart = RestartKind::restart, .proves_rom = true};
  }
  return {.assignments = goal.set,
          .restart = goal.saves ? std::optional(RestartKind::save) : std::nullopt};
}

bool holds(const bla::Values& values, const Goal& goal) {
  return std::ranges::all_of(goal.set, [&](const Assignment& wish) {
    return bla::find(values, wish.parameter->address) == wish.value.raw;
  });
}

/// What the goal needs, and whether the servo could read its ROM.
Result<std::vector<const bla::Parameter*>> registers_to_read(const Wanted& wish,
                                                             const Servo& servo) {
  auto needed = registers_needed(wish, servo);
  const bla::Parameter* state = wish.restart ? rom_state(servo.identity) : nullptr;
  if (needed && state != nullptr) {
    needed->push_back(state);
  }
  return needed;
}

/// A servo that started with this static node ID would be on it: it stands in RAM only.
bool shows_other_rom(const Goal& goal, const Snapshot& held) {
  return std::ranges::any_of(goal.set, [&](const Assignment& wish) {
    return wish.parameter->address == bla::address::static_node_id && wish.value.raw != 0 &&
           wish.value.raw != held.servo.id.value();
  });
}

/// From what the servo held to what is wished.
std::vector<RegisterChange> changes(const Goal& goal, const Snapshot& held) {
  std::vector<RegisterChange> all;
  for (const Assignment& wish : goal.set) {
    RegisterChange change{.parameter = held.servo.identity.parameter(wish.parameter->address),
                          .requested = wish.value.raw,
                          .before = held.raw(wish.parameter->address)};
    if (change.before == change.requested) {
      change.status = ChangeStatus::unchanged;
      change.after = change.before;
    }
    all.push_back(std::move(change));
  }
  return all;
}

/// What the last of several steps tells of a change that an earlier one may have made.
void learn(RegisterChange& change, const ChangeResult& last) {
  const auto same = std::ranges::find_if(last.changes, [&](const RegisterChange& each) {
    return each.parameter->address == change.parameter->address;
  });
  if (same == last.changes.end()) {
    return;
  }
  change.after = same->after;
  change.error = same->error;
  const bool was_made = change.is_planned() && same->status == ChangeStatus::unchanged;
  change.status = was_made ? ChangeStatus::written : same->status;
}

/// A restart has not shown that ROM holds what is wished.
bool is_unproven(const GoalResult& result, const UnitChange& unit) {
  return result.need == Need::prove && unit.is_done && unit.last &&
         !(unit.last->rom && holds(unit.last->rom->values, result.goal));
}

bool names(const Goal& goal, bla::Address address) {
  return std::ranges::any_of(
      goal.set, [&](const Assignment& wish) { return wish.parameter->address == address; });
}

/// What the goal does not name, and RAM and ROM hold differently: SAVE keeps it, a restart ends it.
std::vector<Warning> unnamed(const Goal& goal, const Snapshot& ram, const bla::Values& rom,
                             Need need) {
  std::vector<Warning> warnings;
  for (const Reading& reading : ram.readings) {
    const bla::Parameter& parameter = *reading.parameter;
    const auto kept = bla::find(rom, parameter.address);
    if (!bla::is_setting(parameter.address) || names(goal, parameter.address) || !reading.raw ||
        !kept || kept == reading.raw) {
      continue;
    }
    const std::string in_ram = bla::display(parameter, *reading.raw, ram.pwm_mode());
    const std::string in_rom = bla::display(parameter, *kept, ram.pwm_mode());
    warnings.push_back(
        need == Need::prove
            ? Warning{"unnamed_lost", say<texts::unnamed_lost>(parameter.name, in_ram, in_rom)}
            : Warning{"unnamed_saved", say<texts::unnamed_saved>(parameter.name, in_ram, in_rom)});
  }
  return warnings;
}

GoalResult planned(Goal goal, Need need, const Snapshot& held) {
  GoalResult result{.goal = std::move(goal), .need = need, .servo = held.servo};
  result.changes = changes(result.goal, held);
  result.mode_before = result.mode_after = held.pwm_mode();
  for (const RegisterChange& change : result.changes) {
    if (change.parameter->address == bla::address::pwm_mode) {
      result.mode_after = change.requested;
    }
  }
  result.is_done = need == Need::nothing;
  result.node_id_after = held.servo.id;
  return result;
}

} // namespace

std::string_view name(Need need) {
  switch (need) {
  case Need::nothing: return "nothing";
  case Need::prove: return "restart";
  case Need::save: return "save";
  case Need::write: return "write";
  }
  return {};
}

bool GoalResult::has_differences() const {
  return std::ranges::any_of(
      changes, [](const RegisterChange& change) { return change.before != change.requested; });
}

std::vector<Error> Apply::prepare(std::vector<Goal> goals) {
  for (Goal& goal : goals) {
    results_.push_back({.goal = std::move(goal), .servo = {}});
  }
  std::vector<std::size_t> all(results_.size());
  std::iota(all.begin(), all.end(), 0U);
  return prepare(all, change_, begun_);
}

/// RAM that is going to be saved must be what it was before this run, save where that restarted the
/// servo itself.
Result<Apply::Snapshots> Apply::read(std::span<const std::size_t> goals) {
  std::map<NodeId, Wanted> all;
  std::vector<NodeId> nodes;
  auto proof = ReadJob::Proof::moment;
  for (const std::size_t i : goals) {
    const Goal& goal = results_[i].goal;
    nodes.push_back(goal.id);
    if (goal.saves && !results_[i].was_begun) {
      proof = ReadJob::Proof::run;
    }
    all.insert_or_assign(goal.id, wanted(goal, Need::write));
  }
  auto read = take_snapshots(
      session_, profiles_, nodes, options_.change.manner.identification,
      [&](const Servo& servo) { return registers_to_read(all.at(servo.id), servo); }, proof);
  if (read.broken) {
    return std::unexpected(*read.broken);
  }
  return std::move(read.servos);
}

Need Apply::need(const Goal& goal, const Snapshot& held,
                 const std::optional<bla::Values>& rom) const {
  if (!holds(held.values(), goal)) {
    return Need::write;
  }
  if (goal.saves && check_rom(held)) { // it holds initial values for want of its ROM
    return Need::save;
  }
  if (rom) {
    return holds(*rom, goal) ? Need::nothing : Need::save;
  }
  if (goal.saves && shows_other_rom(goal, held)) {
    return Need::save;
  }
  return goal.saves && !options_.trusts_ram ? Need::prove : Need::nothing;
}

/// `units`: the goals for which something has to be done.
std::vector<Error> Apply::prepare(std::span<const std::size_t> goals, FleetChange& change,
                                  std::vector<std::size_t>& units) {
  auto snapshots = read(goals);
  if (!snapshots) {
    return {snapshots.error()};
  }
  const Roster& roster = session_.roster();
  std::vector<Error> errors;
  std::vector<UnitTask> tasks;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    Snapshot& held = (*snapshots)[i];
    GoalResult& result = results_[goals[i]];
    if (roster.is_doubled(result.goal.id)) {
      errors.push_back(doubled(roster, result.goal.id));
    } else if (auto error = held.first_error()) {
      errors.push_back(std::move(*error));
    } else {
      const auto rom = result.goal.saves && options_.proven_rom ? options_.proven_rom(held.servo)
                                                                : std::optional<bla::Values>();
      const Need need = this->need(result.goal, held, rom);
      const bool was_begun = result.was_begun;
      const Duration duration = result.duration;
      result = planned(std::move(result.goal), need, held);
      result.was_begun = was_begun; // to see what its ROM holds
      result.duration = duration;
      result.is_verified = result.is_done && result.goal.saves && !options_.trusts_ram
                               ? std::optional(true)
                               : std::nullopt;
      if (result.need != Need::nothing) {
        result.warnings = rom ? unnamed(result.goal, held, *rom, need) : std::vector<Warning>();
        units.push_back(goals[i]);
        tasks.push_back({std::move(held), wanted(result.goal, result.need)});
      }
    }
  }
  if (!errors.empty()) {
    return errors;
  }
  errors = change.prepare(std::move(tasks));
  for (std::size_t i = 0; errors.empty() && i < units.size(); ++i) {
    const auto& warnings = change.units()[i].plan.warnings;
    auto& told = results_[units[i]].warnings;
    told.insert(told.begin(), warnings.begin(), warnings.end());
  }
  return errors;
}

std::vector<Error> Apply::carry_out() {
  std::vector<Error> errors;
  if (!begun_.empty()) {
    errors = change_.carry_out([](const IdMove&) {});
    conclude(change_, begun_);
    const bool has_failed = std::ranges::any_of(change_.units(), &UnitChange::has_failed);
    if (errors.empty() && !(has_failed && options_.change.stops_at_failure)) {
      errors = write_what_rom_lacks();
    }
  }
  look_back();
  return errors;
}

/// Is what was found to be right still true of those that nothing was done to, as far as was heard?
void Apply::look_back() {
  const Roster& roster = session_.roster();
  for (GoalResult& result : results_) {
    if (result.need != Need::nothing) {
      continue; // its own job has looked
    }
    const NodeId id = result.servo.id;
    const bool restarted = roster.member(id).boots != result.servo.boot;
    if (roster.is_doubled(id)) {
      result.errors.push_back(doubled(roster, id));
    } else if (const auto writer = roster.writer_to(id, result.servo.since)) {
      result.errors.push_back({Code::state,
                               say<texts::written_by_other>(id.value(), writer->value()),
                               say<texts::other_writer_hint>(), id.value()});
    } else if (restarted && !result.is_verified) { // RAM is what ROM held now
      result.errors.push_back({Code::state, say<texts::lost_since>(id.value()),
                               say<texts::run_again_hint>(), id.value()});
    }
    result.is_done = result.errors.empty();
  }
}

void Apply::conclude(const FleetChange& change, std::span<const std::size_t> units) {
  for (std::size_t i = 0; i < units.size(); ++i) {
    const UnitChange& unit = change.units()[i];
    GoalResult& result = results_[units[i]];
    result.is_done = unit.is_done && !is_unproven(result, unit);
    if (!unit.last) {
      continue;
    }
    const ChangeResult& last = *unit.last;
    result.was_begun = result.was_begun || last.was_begun;
    result.errors = last.errors();
    result.servo.servo_id = last.servo.servo_id;
    result.saved = last.saved && unit.is_done;
    if (unit.is_done && !result.is_done && !last.rom) {
      result.errors.push_back({Code::state, say<texts::restarts_while_read>(last.servo.id.value()),
                               say<texts::restarts_again_hint>(), last.servo.id.value()});
    }
    result.is_verified = result.goal.saves ? std::optional(result.is_done) : std::nullopt;
    if (result.need == Need::prove && last.rom) {
      result.warnings = unnamed(result.goal, unit.plan.before, last.rom->values, result.need);
    }
    result.node_id_after = last.node_id_after;
    result.duration += last.duration;
    std::ranges::for_each(result.changes, [&](RegisterChange& each) { learn(each, last); });
  }
}

/// Where the restart has shown that ROM holds something else, that is written now.
std::vector<Error> Apply::write_what_rom_lacks() {
  std::vector<std::size_t> lacking;
  for (std::size_t i = 0; i < begun_.size(); ++i) {
    GoalResult& result = results_[begun_[i]];
    if (is_unproven(result, change_.units()[i])) {
      result.goal.id = result.node_id_after.value_or(result.goal.id);
      lacking.push_back(begun_[i]);
    }
  }
  if (lacking.empty()) {
    return {};
  }
  FleetChange change(session_, profiles_, table_, options_.change);
  std::vector<std::size_t> units;
  if (auto errors = prepare(lacking, change, units); !errors.empty()) {
    return errors;
  }
  auto errors = change.carry_out([](const IdMove&) {});
  conclude(change, units);
  return errors;
}

} // namespace blactl::fleet
