#include "blactl/fleet/change/survey.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/change/history.hpp"

#include "fleet/change/id_texts.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <array>
#include <list>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using dronecan::NodeId;

namespace {

bool gives_id(const Plan& plan) {
  return plan.given_node_id() || plan.given_servo_id();
}

bool gives_new_servo_id(const Plan& plan) {
  const RegisterChange* change = plan.change_of(at::servo_id);
  return (change != nullptr && change->is_planned()) ||
         (plan.given_servo_id() && plan.restart == RestartKind::restart);
}

/// Asks the holders of the assigned node IDs, including silent units.
std::optional<Error> ask_holders(Session& session, std::span<const Plan> plans,
                                 const Identification::Options& options) {
  std::list<UnitJob> jobs;
  std::vector<dronecan::Job*> group;
  for (const Plan& plan : plans) {
    if (const auto given = plan.given_node_id(); given && *given != session.roster().local()) {
      group.push_back(&jobs.emplace_back(session.records(), *given, options.patience));
    }
  }
  const auto ran = session.run(group);
  return ran ? std::nullopt : std::optional(ran.error());
}

/// The value of a servo after the plans: as planned, else as in its RAM.
std::optional<std::int64_t> after(std::span<const Plan> plans, const Neighbour& servo,
                                  bla::Address address, std::optional<std::int64_t> in_ram) {
  const auto plan = std::ranges::find_if(
      plans, [&](const Plan& each) { return each.before.servo.id == servo.id; });
  if (plan == plans.end()) {
    return in_ram;
  }
  if (const RegisterChange* change = plan->change_of(address)) {
    return change->requested;
  }
  return plan->erase && !plan->keep_ids ? std::optional<std::int64_t>(0) : in_ram;
}

/// Whether no plan changes its ROM.
bool stays(std::span<const Plan> plans, const Neighbour& servo) {
  return std::ranges::none_of(plans, [&](const Plan& plan) {
    return plan.before.servo.id == servo.id && plan.restart == RestartKind::save;
  });
}

Error taken(const Plan& plan, NodeId given, const std::optional<dronecan::UniqueId>& holder) {
  const std::uint8_t id = plan.before.servo.id.value();
  return {Code::duplicate_node_id,
          holder ? say<texts::id_given_is_taken>(id, given.value(), hex(*holder))
                 : say<texts::id_given_is_kept>(id, given.value()),
          say<texts::node_id_in_use_hint>(), id};
}

Error servo_id_taken(std::uint8_t id, std::int64_t servo_id, NodeId holder) {
  return {Code::duplicate_servo_id,
          say<texts::servo_id_given_is_taken>(id, servo_id, holder.value()),
          say<texts::servo_id_taken_hint>(), id};
}

Result<std::vector<Snapshot>> read_ids(Session& session, const bla::Profiles& profiles,
                                       const Identification::Options& options,
                                       Unidentified unidentified, std::optional<NodeId> except) {
  const Roster& roster = session.roster();
  std::vector<NodeId> nodes;
  for (const auto& [id, member] : roster.members()) {
    const bool may_be_servo = member.is_servo || member.sends_actuator_status() ||
                              (unidentified == Unidentified::asked && !member.identified);
    if (id != except && roster.heard(id) && may_be_servo) {
      nodes.push_back(id);
    }
  }
  const auto ids = [](const Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
    return servo.identity.registers(
        std::array{at::servo_id, at::static_node_id, at::fault_warning});
  };
  auto snapshots = take_snapshots(session, profiles, nodes, options, ids);
  if (snapshots.broken) {
    return std::unexpected(*snapshots.broken);
  }
  return std::move(snapshots.servos);
}

/// What one node tells of its IDs; empty: it is no actuator.
std::optional<Neighbour> neighbour(const Session& session, const Snapshot& snapshot) {
  const Member member = session.roster().member(snapshot.servo.id);
  if (!member.is_servo && !member.sends_actuator_status()) {
    return std::nullopt;
  }
  return Neighbour{.id = snapshot.servo.id,
                   .unique_id = snapshot.servo.unique_id,
                   .servo_id =
                       member.is_foreign() ? member.commanded_id() : snapshot.raw(at::servo_id),
                   .static_node_id = snapshot.raw(at::static_node_id),
                   .is_foreign = member.is_foreign(),
                   .is_rom_unread = check_rom(snapshot).has_value()};
}

} // namespace

Result<std::vector<Neighbour>> neighbours(Session& session, const bla::Profiles& profiles,
                                          const Identification::Options& options,
                                          Unidentified unidentified, std::optional<NodeId> except) {
  const auto snapshots = read_ids(session, profiles, options, unidentified, except);
  if (!snapshots) {
    return std::unexpected(snapshots.error());
  }
  std::vector<Neighbour> found;
  for (const Snapshot& snapshot : *snapshots) {
    if (auto one = neighbour(session, snapshot)) {
      found.push_back(*one);
    }
  }
  return found;
}

Result<Survey> survey(Session& session, const bla::Profiles& profiles, std::span<const Plan> plans,
                      const Identification::Options& options, History* record) {
  Survey found;
  if (std::ranges::none_of(plans, gives_id)) {
    return found;
  }
  if (auto broken = ask_holders(session, plans, options)) {
    return std::unexpected(std::move(*broken));
  }
  for (const auto& [id, member] : session.roster().members()) {
    if (session.roster().heard(id)) {
      found.holders[id] = member.unique_id();
    }
  }
  if (record != nullptr) {
    found.waiting = record->waiting(session.roster());
  }
  const bool gives_servo_id = std::ranges::any_of(plans, gives_new_servo_id);
  const auto snapshots =
      read_ids(session, profiles, options,
               gives_servo_id ? Unidentified::asked : Unidentified::left_out, std::nullopt);
  if (!snapshots) {
    return std::unexpected(snapshots.error());
  }
  for (const Snapshot& snapshot : *snapshots) {
    auto servo = neighbour(session, snapshot);
    if (!servo) {
      continue;
    }
    if (!servo->servo_id || !(servo->static_node_id || servo->is_foreign)) {
      found.silent.push_back(servo->id);
    }
    if (!servo->servo_id) { // it does not answer, but it sends the ID ten times a second
      servo->servo_id = session.roster().member(servo->id).actuator_id;
    }
    if (record != nullptr && !servo->is_rom_unread) {
      bla::Values rom = record->known_rom(snapshot, session);
      rom.merge(record->saved_since_start(snapshot.servo, session));
      servo->rom_servo_id = bla::find(rom, at::servo_id);
      servo->rom_static_node_id = bla::find(rom, at::static_node_id);
    } else if (record != nullptr) { // no node ID at all is given beside it
      servo->rom_servo_id = bla::find(record->last_proven_ids(snapshot.servo), at::servo_id);
    }
    found.servos.push_back(*servo);
  }
  return found;
}

std::optional<Error> conflict(const Survey& survey, std::span<const Plan> plans, const Plan& plan) {
  const Servo& servo = plan.before.servo;
  const std::uint8_t id = servo.id.value();
  const auto node_id = plan.given_node_id();
  if (node_id && *node_id != servo.id) {
    const auto holder = survey.holders.find(*node_id);
    if (holder != survey.holders.end() && holder->second != servo.unique_id) {
      return taken(plan, *node_id, holder->second);
    }
  }
  for (const Neighbour& other : survey.servos) {
    if (other.id == servo.id) {
      continue;
    }
    const auto its_node_id = after(plans, other, at::static_node_id, other.static_node_id);
    if (node_id && its_node_id == node_id->value()) {
      return Error{Code::duplicate_node_id,
                   say<texts::id_given_will_be_taken>(id, node_id->value(), other.id.value()),
                   say<texts::node_id_in_use_hint>(), id};
    }
  }
  return servo_id_conflict(survey, plans, plan);
}

std::optional<Error> servo_id_conflict(const Survey& survey, std::span<const Plan> plans,
                                       const Plan& plan) {
  const std::uint8_t id = plan.before.servo.id.value();
  const auto servo_id = plan.given_servo_id();
  const auto own = std::ranges::find(survey.servos, plan.before.servo.id, &Neighbour::id);
  const bool is_new_in_rom = plan.restart == RestartKind::save && own != survey.servos.end() &&
                             own->rom_servo_id && own->rom_servo_id != servo_id;
  for (const Neighbour& other : survey.servos) {
    if (!servo_id || other.id == plan.before.servo.id) {
      continue;
    }
    if (after(plans, other, at::servo_id, other.servo_id) == servo_id) {
      return servo_id_taken(id, *servo_id, other.id);
    }
    if ((gives_new_servo_id(plan) || is_new_in_rom) && stays(plans, other) &&
        other.rom_servo_id == servo_id) {
      const std::uint8_t its_id = other.id.value();
      return other.is_rom_unread
                 ? Error{Code::duplicate_servo_id,
                         say<texts::servo_id_given_is_unread>(id, *servo_id, its_id),
                         say<texts::id_in_unread_rom_hint>(its_id), id}
                 : Error{Code::duplicate_servo_id,
                         say<texts::servo_id_given_is_in_rom>(id, *servo_id, its_id),
                         say<texts::servo_id_given_is_in_rom_hint>(its_id), id};
    }
  }
  return std::nullopt;
}

std::optional<Error> rom_node_id_conflict(const Survey& survey, std::span<const Plan> plans,
                                          const Plan& plan) {
  const std::uint8_t id = plan.before.servo.id.value();
  const auto given = plan.given_node_id();
  for (const Neighbour& other : survey.servos) {
    if (given && other.id != plan.before.servo.id && stays(plans, other) &&
        other.rom_static_node_id == given->value()) {
      return Error{Code::duplicate_node_id,
                   say<texts::node_id_given_is_in_rom>(id, given->value(), other.id.value()),
                   say<texts::servo_id_given_is_in_rom_hint>(other.id.value()), id};
    }
  }
  for (const Waiting& other : survey.waiting) {
    if (given && other.rom_static_node_id == given->value()) {
      return Error{Code::duplicate_node_id,
                   say<texts::node_id_given_is_in_waiting_rom>(id, given->value()),
                   say<texts::node_id_given_is_in_waiting_rom_hint>(hex(other.unique_id)), id};
    }
  }
  return std::nullopt;
}

std::optional<Error> newcomer_conflict(const Roster& roster, Time surveyed, const Plan& plan) {
  const auto servo_id = plan.given_servo_id();
  const auto node_id = plan.given_node_id();
  for (const auto& [id, member] : roster.members()) {
    const bool is_new = id != plan.before.servo.id && member.first_heard > surveyed;
    const auto& own = plan.before.servo.unique_id;
    if (is_new && node_id == id && !(own && member.is_unit(*own))) {
      return taken(plan, id, member.unique_id());
    }
  }
  const Member* holder =
      servo_id ? roster.newcomer_with(*servo_id, surveyed, plan.before.servo.id, {}) : nullptr;
  return holder != nullptr
             ? std::optional(servo_id_taken(plan.before.servo.id.value(), *servo_id, holder->id))
             : std::nullopt;
}

} // namespace blactl::fleet
