#include "blactl/fleet/change/guard.hpp"

#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/plan.hpp"

#include "fleet/change/texts.hpp"

#include <cstdint>
#include <list>
#include <map>

namespace blactl::fleet {
namespace {

/// Silent nodes take long: others may come or restart meanwhile, but not again and again.
constexpr int most_rounds = 3;

/// Asks each node that nobody has asked yet for its unique ID, or that has restarted since: it may
/// be that of one to be changed. A servo need not have sent actuator.Status yet.
Result<void> ask_units(Session& session, Patience patience) {
  std::map<dronecan::NodeId, std::uint32_t> asked; // and its boots
  for (int round = 0; round < most_rounds && !session.is_replay(); ++round) {
    std::list<UnitJob> jobs;
    std::vector<dronecan::Job*> group;
    for (const auto& [id, member] : session.roster().members()) {
      const bool has_told = member.info && member.is_unit(member.info->unique_id);
      const auto before = asked.find(id);
      const bool is_asked = before != asked.end() && before->second == member.boots;
      if (session.roster().heard(id) && !has_told && !is_asked) {
        asked[id] = member.boots;
        group.push_back(&jobs.emplace_back(session.records(), id, patience));
      }
    }
    if (auto ran = session.run(group); !ran || group.empty()) {
      return ran;
    }
  }
  return {};
}

/// A value in RAM is judged by the settings beside it: one that another node has changed since they
/// were read may forbid it. Before SAVE all of them are read again.
std::optional<Error> changed_since_read(const Roster& roster, const Plan& plan) {
  const Servo& servo = plan.before.servo;
  const std::uint8_t id = servo.id.value();
  if (plan.restart || plan.erase) {
    return std::nullopt;
  }
  for (const auto& [address, raw] : plan.before.values()) {
    const auto writer = servo.identity.is_setting(address)
                            ? roster.setter_of(servo.id, servo.since, address)
                            : std::nullopt;
    if (writer) {
      return Error{Code::state, say<texts::written_by_other>(id, writer->value()),
                   say<texts::run_again_hint>(), id};
    }
  }
  return std::nullopt;
}

} // namespace

std::optional<Error> Guard::forbids(const Servo& servo, Time now,
                                    std::optional<std::int64_t> next_servo_id) const {
  const std::uint8_t id = servo.id.value();
  if (roster_->is_doubled(servo.id)) {
    return doubled(*roster_, servo.id);
  }
  if (auto error = not_unique(*roster_, servo.id)) {
    return error;
  }
  if (const auto by = roster_->armed_by(now)) {
    return Error{Code::armed, say<texts::armed>(by->value()), say<texts::armed_hint>(), id};
  }
  if (const auto driver = roster_->driver_of(servo, now); driver && !may_be_driven_) {
    return Error{Code::driven, say<texts::driven>(driver->value(), id), say<texts::driven_hint>(),
                 id};
  }
  const bool may_become_driven = may_become_driven_ || !next_servo_id;
  if (const auto driver = may_become_driven || servo.servo_id == next_servo_id
                              ? std::nullopt
                              : roster_->commander_of_id(*next_servo_id, now)) {
    return Error{Code::driven, say<texts::id_is_driven>(driver->value(), *next_servo_id, id),
                 say<texts::driven_hint>(), id};
  }
  return std::nullopt;
}

dronecan::Request Guard::guarded(dronecan::Request request, const Servo& servo,
                                 std::optional<std::int64_t> next_servo_id) const {
  request.may_leave = [guard = *this, &servo, next_servo_id](Time now) {
    return !guard.forbids(servo, now, next_servo_id);
  };
  return request;
}

std::optional<Error> forbidden(const Roster& roster, Time now, const Plan& plan,
                               bool while_driven) {
  const Servo& servo = plan.before.servo;
  const std::uint8_t id = servo.id.value();
  if (roster.is_doubled(servo.id)) {
    return doubled(roster, servo.id);
  }
  if (!plan.acts()) {
    return std::nullopt;
  }
  // readings and responses are from before a restart
  if (!roster.member(servo.id).is_known() || roster.member(servo.id).boots != servo.boot) {
    return Error{Code::state, say<texts::restarted_before_write>(id), say<texts::run_again_hint>(),
                 id};
  }
  const Guard guard(roster, while_driven || !plan.waits_for_driver(), while_driven);
  if (auto why = guard.forbids(servo, now)) {
    return why;
  }
  for (const std::int64_t next : plan.next_servo_ids()) {
    if (auto why = guard.forbids(servo, now, next)) {
      return why;
    }
  }
  if (const auto writer = roster.renumbered_by(servo)) {
    return Error{Code::state, say<texts::written_by_other>(id, writer->value()),
                 say<texts::run_again_hint>(), id};
  }
  if (auto why = changed_since_read(roster, plan)) {
    return why;
  }
  if (const auto given = plan.given_node_id(); given && *given == roster.local()) {
    return Error{Code::out_of_range, say<texts::node_id_is_ours>(given->value()),
                 say<texts::node_id_is_ours_hint>(), id};
  }
  return std::nullopt;
}

OthersHeard hear_others(Session& session, Patience patience, std::optional<Time> searched,
                        std::span<const dronecan::UniqueId> own) {
  OthersHeard heard;
  auto lived = hear_bus(session);
  if (lived) {
    lived = ask_units(session, patience);
  }
  if (!lived) {
    heard.errors.push_back(lived.error());
    return heard;
  }
  const Roster& roster = session.roster();
  for (const auto& [id, member] : roster.members()) {
    const auto unit = member.unique_id();
    const bool is_own = unit && std::ranges::find(own, *unit) != own.end();
    if (searched && member.first_heard > *searched && member.sends_actuator_status() && !is_own) {
      heard.errors.push_back({Code::state, say<texts::came_since>(id.value()),
                              say<texts::run_again_hint>(), id.value()});
    }
  }
  if (searched && !roster.pending().empty()) {
    heard.notes.push_back(say<texts::units_wait_for_id>(roster.pending().size()));
  }
  return heard;
}

} // namespace blactl::fleet
