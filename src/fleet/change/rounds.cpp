#include "fleet/change/rounds.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/guard.hpp"

#include "fleet/change/id_holders.hpp"
#include "fleet/change/id_texts.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <ranges>
#include <set>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

using Wish = state::AllocationStore::Wish;

std::vector<Wish> wishes_of(std::span<const UnitChange> units) {
  std::vector<Wish> wishes;
  for (const UnitChange& unit : units) {
    if (const auto id = unit.static_node_id()) {
      wishes.push_back({unit.unique_id, *id});
    }
  }
  return wishes;
}

/// The units that give up their static node ID for good.
std::vector<dronecan::UniqueId> becoming_dynamic(std::span<const UnitChange> units) {
  std::vector<dronecan::UniqueId> dynamic;
  for (const UnitChange& unit : units) {
    const RegisterChange* change = unit.plan.change_of(bla::address::static_node_id);
    if (unit.plan.restart == RestartKind::save && change != nullptr && change->is_planned() &&
        change->requested == 0) {
      dynamic.push_back(unit.unique_id);
    }
  }
  return dynamic;
}

/// As RAM will hold them: one that another unit is to get is not in its way if this change takes it
/// from RAM, as ROM does not hold it. (See rom_node_id_conflict() where it does.)
void take_from_ram(std::span<const UnitChange> units, std::vector<IdHolder>& holders) {
  for (const UnitChange& unit : units) {
    const RegisterChange* change = unit.plan.change_of(bla::address::static_node_id);
    const auto holder = std::ranges::find(holders, unit.unique_id, &IdHolder::unique_id);
    if (unit.plan.restart != RestartKind::save && change != nullptr && change->is_planned() &&
        holder != holders.end()) {
      holder->static_node_id = change->requested;
    }
  }
}

} // namespace

std::optional<NodeId> UnitChange::static_node_id() const {
  const auto saved = plan.restart == RestartKind::save
                         ? bla::find(plan.expected, bla::address::static_node_id)
                         : std::nullopt;
  const bool is_given =
      saved.value_or(0) != 0 && (*saved != plan.before.servo.id.value() ||
                                 saved != plan.before.raw(bla::address::static_node_id));
  return is_given ? std::optional(NodeId(static_cast<std::uint8_t>(*saved))) : std::nullopt;
}

std::vector<Error> Rounds::prepare(std::vector<UnitTask> tasks) {
  auto errors = make_plans(std::move(tasks));
  if (!errors.empty()) {
    return errors;
  }
  const auto survey = look_around();
  if (!survey) {
    return {survey.error()};
  }
  errors = make_rounds();
  if (errors.empty()) {
    errors = check_ids(*survey);
  }
  if (errors.empty()) {
    errors = make_way(*survey);
  }
  return errors.empty() ? check() : errors;
}

std::vector<Error> Rounds::make_plans(std::vector<UnitTask> tasks) {
  const Roster& roster = session_.roster();
  std::vector<Error> errors;
  for (UnitTask& task : tasks) {
    const NodeId id = task.before.servo.id;
    const auto unique_id = task.before.servo.unique_id;
    auto plan = make_plan(task.wanted, std::move(task.before), profiles_);
    if (!plan || !unique_id) { // two that respond at the same time cannot be read
      errors.push_back(roster.is_doubled(id) ? doubled(roster, id)
                       : plan                ? fleet::silent(roster, id)
                                             : std::move(plan.error()));
      continue;
    }
    units_.push_back({.unique_id = *unique_id,
                      .wanted = std::move(task.wanted),
                      .plan = std::move(*plan),
                      .now = id});
  }
  return errors;
}

/// Finds the holders of node IDs, if IDs are assigned: the bus is searched for it once.
Result<void> Rounds::learn_ids() {
  if (options_.knows_ids) {
    return {};
  }
  options_.knows_ids = true;
  Discovery discovery(session_, profiles_, options_.manner.identification);
  return discovery.find_all(bus_watch_time);
}

/// Who has which IDs, of all on the bus.
Result<Survey> Rounds::look_around() {
  if (!wishes_of(units_).empty()) {
    if (const auto learned = learn_ids(); !learned) {
      return std::unexpected(learned.error());
    }
  }
  auto survey = fleet::survey(session_, profiles_, plans(), options_.manner.identification,
                              options_.manner.proofs);
  surveyed_ = options_.manner.surveyed = session_.roster().last_heard();
  for (const UnitChange& unit : units_) {
    options_.manner.own.insert(unit.unique_id);
  }
  if (survey) {
    learn_servo_ids(*survey);
  }
  return survey;
}

/// The allocation table; if it cannot be used, one that ends with this change: the caller of
/// `not_kept` decides whether that is a reason to change nothing.
Result<state::AllocationStore*> Rounds::table() {
  if (!table_) {
    auto opened = options_.manner.allocations ? options_.manner.allocations()
                                              : state::AllocationStore::unshared();
    if (!opened) {
      if (auto refused =
              options_.manner.not_kept ? options_.manner.not_kept(opened.error()) : std::nullopt) {
        return std::unexpected(std::move(*refused));
      }
      opened = state::AllocationStore::unshared();
    }
    if (!opened) {
      return std::unexpected(opened.error());
    }
    table_ = std::move(*opened);
  }
  return &*table_;
}

/// Servos without a wanted ID begin at once.
std::vector<Error> Rounds::make_rounds() {
  const std::vector<Wish> wishes = wishes_of(units_);
  IdRounds moves;
  if (!wishes.empty()) {
    const auto own = std::ranges::find(wishes, session_.roster().local(),
                                       &state::AllocationStore::Wish::node_id);
    if (own != wishes.end()) {
      return {{Code::duplicate_node_id, say<texts::node_id_is_ours>(own->node_id.value()),
               say<texts::node_id_is_ours_hint>(), own->node_id.value()}};
    }
    const auto table = this->table();
    const auto ids = table ? taken_ids(session_.roster(), **table, wishes)
                           : Result<TakenIds>(std::unexpected(table.error()));
    if (!ids) {
      return {ids.error()};
    }
    auto units = holders(session_.roster(), wishes);
    take_from_ram(units_, units);
    auto planned =
        plan_id_moves(units, wishes, ids->taken, ids->promised, becoming_dynamic(units_));
    if (!planned) {
      return planned.error();
    }
    moves = std::move(*planned);
    absent_ = ids->absent;
    note_takeovers();
  }
  add_rounds(moves);
  return {};
}

/// Those that move, each in its round; all others in the first one.
void Rounds::add_rounds(const IdRounds& moves) {
  rounds_.assign(std::max<std::size_t>(moves.size(), 1), {});
  std::set<std::size_t> moving;
  for (std::size_t r = 0; r < moves.size(); ++r) {
    for (const IdMove& move : moves[r]) {
      const auto found = std::ranges::find(units_, move.unique_id, &UnitChange::unique_id);
      const auto unit = static_cast<std::size_t>(found - units_.begin());
      rounds_[r].push_back({.unit = unit, .move = move});
      moving.insert(unit);
      if (move.is_temporary) {
        notes_.push_back(say<texts::will_make_way>(move.from.value(), move.to.value()));
      }
      if (move.is_dynamic) {
        notes_.push_back(say<texts::will_ask_for_another_id>(move.from.value()));
      }
    }
  }
  for (std::size_t i = 0; i < units_.size(); ++i) {
    if (!moving.contains(i) && !units_[i].static_node_id()) {
      rounds_.front().push_back({.unit = i});
    }
  }
}

/// A user's wish takes the ID of a unit that is away.
void Rounds::note_takeovers() {
  for (const UnitChange& unit : units_) {
    const auto former = std::ranges::find(absent_, unit.static_node_id(), [](const auto& entry) {
      return std::optional(entry.node_id);
    });
    if (former != absent_.end()) {
      notes_.push_back(say<texts::id_taken_over>(former->node_id.value(), hex(former->unique_id),
                                                 unit.now.value()));
    }
  }
}

/// A servo that could not read its ROM holds no ID; its next start may bring one back.
std::vector<Error> Rounds::check_unread(const Survey& survey, std::span<const Plan> plans) {
  std::vector<Error> errors;
  for (const Neighbour& other : survey.servos) {
    const bool stays = std::ranges::none_of(
        plans, [&](const Plan& plan) { return plan.before.servo.id == other.id; });
    if (!stays || !other.is_rom_unread) {
      continue;
    }
    for (const Plan& plan : plans) {
      if (const auto given = plan.given_node_id()) {
        const std::uint8_t id = plan.before.servo.id.value();
        errors.push_back({Code::rom_unread,
                          say<texts::id_in_unread_rom>(id, given->value(), other.id.value()),
                          say<texts::id_in_unread_rom_hint>(other.id.value()), id});
      }
    }
    if (errors.empty()) {
      notes_.push_back(say<texts::servo_id_in_unread_rom>(other.id.value()));
    }
  }
  return errors;
}

/// Checks that no other servo has the assigned servo IDs, or the static node IDs that are only
/// written to RAM: those that are saved are checked by the rounds.
std::vector<Error> Rounds::check_ids(const Survey& survey) {
  const std::vector<Plan> plans = this->plans();
  for (const NodeId id : survey.silent) {
    notes_.push_back(say<texts::did_not_tell_ids>(id.value()));
  }
  auto errors = check_unread(survey, plans);
  for (const Plan& plan : plans) {
    auto error = plan.restart == RestartKind::save ? servo_id_conflict(survey, plans, plan)
                                                   : conflict(survey, plans, plan);
    error = error ? std::move(error) : rom_node_id_conflict(survey, plans, plan);
    if (error) {
      errors.push_back(std::move(*error));
    }
  }
  return errors;
}

std::vector<Error> Rounds::check() const {
  std::vector<Error> errors;
  for (const UnitChange& unit : units_) {
    if (auto error =
            forbidden(session_.roster(), session_.now(), unit.plan, options_.manner.while_driven)) {
      errors.push_back(std::move(*error));
    } else if (auto newcomer = newcomer_conflict(session_.roster(), surveyed_, unit.plan)) {
      errors.push_back(std::move(*newcomer));
    }
  }
  return errors;
}

std::vector<Plan> Rounds::plans() const {
  std::vector<Plan> plans;
  std::ranges::transform(units_, std::back_inserter(plans), &UnitChange::plan);
  return plans;
}

/// A person compares them with the labels.
std::string Rounds::given_ids() const {
  std::map<NodeId, std::string> servos;
  for (const UnitChange& unit : units_) {
    const Servo& servo = unit.plan.before.servo;
    const auto id = unit.static_node_id();
    const RegisterChange* change = unit.plan.change_of(bla::address::static_node_id);
    if (id && change != nullptr && change->is_planned()) {
      const auto serial = servo.identity.readings().serial_number;
      servos[*id] = serial ? say<texts::question_id_of_serial>(*serial, id->value())
                           : say<texts::question_id_of_node>(servo.id.value(), id->value());
    }
  }
  std::string given;
  for (const std::string& servo : servos | std::views::values) {
    given += (given.empty() ? "" : ", ") + servo;
  }
  return given.empty() ? given : say<texts::question_ids>(given);
}

std::string Rounds::question() const {
  std::string asked = fleet::question(plans());
  return asked.empty() ? asked : std::move(asked) + given_ids();
}

} // namespace blactl::fleet
