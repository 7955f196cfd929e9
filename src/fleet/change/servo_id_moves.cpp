// Servo IDs that change hands: a servo is saved with one only when no other servo of the change can
// have it any more. One whose ID another waits for makes way first, at once if its own is free,
// else by a temporary one: so a ring of servo IDs takes two rounds. Whatever fails, no ID is in ROM
// twice.

#include "blactl/bla/address.hpp"
#include "blactl/bla/assignment.hpp"

#include "fleet/change/id_texts.hpp"
#include "fleet/change/rounds.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

namespace {

constexpr std::int64_t lowest_servo_id = 1, highest_servo_id = 254; // 4.37

/// The same change, with another value of one register.
Result<Wanted> with_value(const bla::Profiles& profiles, Wanted wanted, bla::Address address,
                          std::int64_t raw) {
  auto assignment = bla::make_assignment(profiles, address.name(), std::to_string(raw));
  if (!assignment) {
    return std::unexpected(assignment.error());
  }
  std::erase_if(wanted.assignments,
                [&](const bla::Assignment& each) { return each.parameter->address == address; });
  wanted.assignments.push_back(std::move(*assignment));
  return wanted;
}

} // namespace

std::optional<std::int64_t> UnitChange::saved_servo_id() const {
  const auto saved = plan.restart == RestartKind::save
                         ? bla::find(plan.expected, bla::address::servo_id)
                         : std::nullopt;
  return saved.value_or(0) != 0 ? saved : std::nullopt;
}

/// As far as known: of what ROM holds, the record tells.
void Rounds::learn_servo_ids(const Survey& survey) {
  for (UnitChange& unit : units_) {
    const auto told = std::ranges::find(survey.servos, unit.now, &Neighbour::id);
    const auto rom = told != survey.servos.end() ? told->rom_servo_id : std::nullopt;
    for (const auto id : {unit.plan.before.raw(bla::address::servo_id), rom}) {
      if (id.value_or(0) != 0) {
        unit.servo_ids.insert(*id);
      }
    }
  }
}

bool Rounds::may_be_held(std::int64_t servo_id, const UnitChange& except) const {
  return std::ranges::any_of(units_, [&](const UnitChange& other) {
    return other.unique_id != except.unique_id && other.servo_ids.contains(servo_id);
  });
}

/// The numbers of the first and last round that a unit takes part in.
std::pair<std::size_t, std::size_t> Rounds::rounds_of(std::size_t unit) const {
  std::pair<std::size_t, std::size_t> found{rounds_.size(), 0};
  for (std::size_t r = 0; r < rounds_.size(); ++r) {
    if (std::ranges::find(rounds_[r], unit, &Step::unit) != rounds_[r].end()) {
      found = {std::min(found.first, r), r};
    }
  }
  return found;
}

/// Whether another unit is to be saved with a servo ID that this one has not given up by then.
bool Rounds::is_waited_for(std::size_t unit) const {
  const std::size_t begins = rounds_of(unit).first;
  for (std::size_t i = 0; i < units_.size(); ++i) {
    const auto wish = units_[i].saved_servo_id();
    if (i != unit && wish && units_[unit].servo_ids.contains(*wish) &&
        rounds_of(i).second <= begins) {
      return true;
    }
  }
  return false;
}

bool Rounds::waits_for_servo_id(const UnitChange& unit) const {
  const auto wish = unit.saved_servo_id();
  return wish && may_be_held(*wish, unit);
}

/// The highest one that nobody has or wants, and no other node sends commands to.
std::optional<std::int64_t> Rounds::free_servo_id(const UnitChange& unit,
                                                  const Survey& survey) const {
  const Roster& roster = session_.roster();
  const auto is_used = [&](std::int64_t id) {
    return std::ranges::any_of(units_,
                               [&](const UnitChange& each) {
                                 return each.servo_ids.contains(id) || each.saved_servo_id() == id;
                               }) ||
           std::ranges::any_of(survey.servos,
                               [&](const Neighbour& each) {
                                 return each.servo_id == id || each.rom_servo_id == id;
                               }) ||
           std::ranges::any_of(roster.members(),
                               [&](const auto& entry) { return entry.second.actuator_id == id; }) ||
           std::ranges::any_of(rounds_, [&](const Round& round) {
             return std::ranges::find(round, std::optional(id), &Step::temporary_servo_id) !=
                    round.end();
           });
  };
  for (std::int64_t id = highest_servo_id; id >= lowest_servo_id; --id) {
    if (!is_used(id) && !roster.commander_of_id(id, session_.now()) &&
        unit.plan.before.servo.identity.may_write(bla::address::servo_id, id)) {
      return id;
    }
  }
  return std::nullopt;
}

/// For a step of a unit that makes way.
std::optional<Error> Rounds::take_temporary(Step& step, const Survey& survey) const {
  const UnitChange& unit = units_[step.unit];
  step.temporary_servo_id = free_servo_id(unit, survey);
  const std::uint8_t id = unit.now.value();
  return step.temporary_servo_id
             ? std::nullopt
             : std::optional(Error{Code::table_full, say<texts::no_temporary_servo_id>(id),
                                   say<texts::no_temporary_servo_id_hint>(), id});
}

/// Servos whose servo ID another one waits for give it up before: on their way to a node ID, or in
/// a round before all others.
std::vector<Error> Rounds::make_way(const Survey& survey) {
  std::vector<Error> errors;
  for (Round& round : rounds_) {
    for (Step& step : round) {
      const bool makes_way = step.move && step.move->is_temporary;
      if (auto error = makes_way && waits_for_servo_id(units_[step.unit])
                           ? take_temporary(step, survey)
                           : std::nullopt) {
        errors.push_back(std::move(*error));
      }
    }
  }
  std::vector<std::size_t> waited_for;
  for (std::size_t i = 0; i < units_.size(); ++i) {
    if (units_[i].plan.restart == RestartKind::save && is_waited_for(i)) {
      waited_for.push_back(i);
    }
  }
  if (!waited_for.empty()) {
    rounds_.insert(rounds_.begin(), Round());
  }
  for (const std::size_t i : waited_for) {
    if (auto error = put_first(i, survey)) {
      errors.push_back(std::move(*error));
    }
  }
  return errors;
}

/// Into the first round: it goes where it is to be, or out of the way.
std::optional<Error> Rounds::put_first(std::size_t number, const Survey& survey) {
  const UnitChange& unit = units_[number];
  Step step{.unit = number};
  if (!unit.static_node_id() && !waits_for_servo_id(unit)) {
    const auto own = std::ranges::find(rounds_[1], number, &Step::unit);
    rounds_.front().push_back(*own);
    rounds_[1].erase(own);
    return std::nullopt;
  }
  if (unit.static_node_id()) {
    step.move = IdMove{unit.unique_id, unit.now, unit.now, true};
  }
  if (auto error = take_temporary(step, survey)) {
    return error;
  }
  rounds_.front().push_back(step);
  notes_.push_back(
      say<texts::will_make_way_by_servo_id>(unit.now.value(), *step.temporary_servo_id));
  return std::nullopt;
}

/// With which the unit is saved in this step; empty: it is not saved, or has none then.
std::optional<std::int64_t> Rounds::servo_id_of(const Step& step) const {
  return step.temporary_servo_id ? step.temporary_servo_id : units_[step.unit].saved_servo_id();
}

/// The change of a unit in one of several steps, each with IDs of its own.
Result<Wanted> Rounds::wanted(const Step& step) const {
  const UnitChange& unit = units_[step.unit];
  Result<Wanted> wanted = unit.wanted;
  if (step.move && !step.move->is_dynamic) {
    wanted = with_value(profiles_, std::move(*wanted), bla::address::static_node_id,
                        step.move->to.value());
  }
  if (wanted && (step.temporary_servo_id || unit.temporary_servo_id)) {
    wanted = with_value(profiles_, std::move(*wanted), bla::address::servo_id,
                        servo_id_of(step).value_or(0));
  }
  return wanted;
}

/// Another unit has failed, and may have the servo ID in its memory.
std::optional<Error> Rounds::servo_id_not_free(const Step& step) const {
  const UnitChange& unit = units_[step.unit];
  const auto given = servo_id_of(step);
  if (!given || !may_be_held(*given, unit)) {
    return std::nullopt;
  }
  const std::uint8_t id = unit.now.value();
  return Error{Code::state,
               unit.temporary_servo_id
                   ? say<texts::servo_id_stays_out_of_the_way>(id, *unit.temporary_servo_id, *given)
                   : say<texts::servo_id_is_not_left>(id, *given),
               say<texts::run_again_hint>(), id};
}

} // namespace blactl::fleet
