#include "blactl/fleet/plan.hpp"

#include "blactl/bla/effect.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using bla::Assignment;
using bla::Parameter;
using bla::Values;

namespace {

using Registers = std::vector<const Parameter*>;

void add(Registers& wanted, const Parameter* parameter) {
  const auto same = [&](const Parameter* other) { return other->address == parameter->address; };
  if (parameter != nullptr && std::ranges::none_of(wanted, same)) {
    wanted.push_back(parameter);
  }
}

/// The registers to be written, 0x37 for the unit of 0x36, and what tells whether a change moves
/// the shaft.
Registers to_judge(const Wanted& wanted, const Servo& servo) {
  Registers registers;
  for (const Assignment& assignment : wanted.assignments) {
    add(registers, servo.identity.parameter(assignment.parameter->address));
  }
  for (const Assignment& assignment : wanted.assignments) {
    if (bla::unit_depends_on_mode(*assignment.parameter)) {
      add(registers, servo.identity.parameter(at::pwm_mode));
    }
    for (const Address needed : bla::values_needed(assignment.parameter->address)) {
      add(registers, servo.identity.parameter(needed));
    }
  }
  return registers;
}

Error about(const Servo& servo, Error error) {
  error.node_id = servo.id.value();
  error.message = say<texts::about_node>(servo.id.value(), error.message);
  return error;
}

/// 0x36 in deg or rpm is right only if 0x37 says so; without a 0x37 beside it, the servo's.
std::optional<Error> check_unit(const Wanted& wanted, const Snapshot& before,
                                const bla::Profiles& profiles) {
  const auto mode = before.raw(at::pwm_mode);
  const auto sets_mode = [](const Assignment& assignment) {
    return assignment.parameter->address == at::pwm_mode;
  };
  if (!mode || std::ranges::any_of(wanted.assignments, sets_mode)) {
    return std::nullopt; // parse_assignments() has compared the two
  }
  for (const Assignment& assignment : wanted.assignments) {
    if (auto fits = bla::check_pwm_unit(profiles, assignment, *mode); !fits) {
      return about(before.servo, fits.error());
    }
  }
  return std::nullopt;
}

/// `held`: what is there when the changes are made.
void plan_changes(const Wanted& wanted, const Values& held, Plan& plan) {
  for (const Assignment& assignment : wanted.assignments) {
    const Address address = assignment.parameter->address;
    Change change{.parameter = plan.before.servo.identity.parameter(address),
                  .requested = assignment.value.raw,
                  .before = bla::find(held, address)};
    if (change.before == change.requested) {
      change.status = ChangeStatus::unchanged;
      change.after = change.before;
    }
    plan.changes.push_back(std::move(change));
  }
  plan.mode_before = plan.mode_after = bla::find(held, at::pwm_mode);
  for (const Change& change : plan.changes) {
    if (change.parameter->address == at::pwm_mode) {
      plan.mode_after = change.requested;
    }
  }
}

/// A command that needs a switch which is off, now and in the same command.
std::optional<Error> check_switches(const Plan& plan) {
  const Values held = plan.before.values();
  for (const Change& change : plan.changes) {
    const auto needed = bla::needs_on(change.parameter->address);
    if (!needed || !change.is_planned()) {
      continue;
    }
    const auto sets = [&](const Change& other) { return other.parameter->address == *needed; };
    const auto set = std::ranges::find_if(plan.changes, sets);
    const auto value =
        set != plan.changes.end() ? std::optional(set->requested) : bla::find(held, *needed);
    if (value == 0) {
      const std::uint8_t id = plan.before.servo.id.value();
      return Error{Code::cross_check,
                   say<texts::about_node>(id, say<texts::control_is_off>(change.parameter->name)),
                   say<texts::control_is_off_hint>(id), id};
    }
  }
  return std::nullopt;
}

std::vector<Warning> warnings_of(const Plan& plan) {
  std::vector<Warning> warnings;
  for (const Change& change : plan.changes) {
    const Parameter& parameter = *change.parameter;
    const auto usual = parameter.default_raw;
    if (change.is_planned() && bla::should_stay_at_default(parameter.address) &&
        usual != change.requested) {
      warnings.push_back(
          {"leave_at_default",
           say<texts::leave_at_default>(parameter.name, usual ? bla::display(parameter, *usual)
                                                              : say<texts::unknown_before>())});
    }
  }
  return warnings;
}

/// --keep-ids: 0x45 and 0x46 back into RAM, unless others are wanted. What is 0 before is 0 after
/// ERASE.
void plan_kept_ids(Plan& plan) {
  for (const Address address : {at::servo_id, at::static_node_id}) {
    const auto kept = plan.before.raw(address);
    const Parameter* parameter = plan.before.servo.identity.parameter(address);
    const bool is_given = std::ranges::any_of(
        plan.changes, [&](const Change& change) { return change.parameter->address == address; });
    if (kept.value_or(0) != 0 && parameter != nullptr && !is_given) {
      plan.changes.push_back({.parameter = parameter, .requested = *kept, .before = 0});
    }
  }
}

/// The configuration once everything is done, as far as it will be proven.
Values expected_after(const Plan& plan) {
  Values expected = plan.expected; // after ERASE
  if (!plan.erase) {
    for (const Parameter* parameter : plan.before.servo.identity.configuration()) {
      if (const auto raw = plan.before.raw(parameter->address)) {
        expected[parameter->address] = *raw;
      }
    }
  }
  for (const Change& change : plan.changes) {
    if (change.parameter->saved) {
      expected[change.parameter->address] = change.requested;
    }
  }
  return expected;
}

/// What SAVE keeps is known; what a mere restart starts with is not.
std::string restart_question(const Plan& plan) {
  const std::uint8_t id = plan.before.servo.id.value();
  if (plan.restart == RestartKind::restart) {
    return say<texts::question_restart_unknown>(id);
  }
  switch (bla::restart_motion(plan.expected)) {
  case bla::RestartMotion::none: break;
  case bla::RestartMotion::soft: return say<texts::question_restart_soft>(id);
  case bla::RestartMotion::hard: return say<texts::question_restart_hard>(id);
  }
  return {};
}

/// What erasing this servo will do, from what to what.
std::string erase_question(const Plan& plan) {
  const auto id_text = [&](Address address) {
    const auto raw = plan.before.raw(address);
    return raw ? std::to_string(*raw) : say<texts::unknown_before>();
  };
  const std::uint8_t id = plan.before.servo.id.value();
  std::string lines = plan.keep_ids ? say<texts::question_erase_keep>(id)
                                    : say<texts::question_erase>(id, id_text(at::servo_id),
                                                                 id_text(at::static_node_id));
  // By default torque is on (4.13).
  if (bla::restart_motion(plan.before.values()) == bla::RestartMotion::none) {
    lines += say<texts::question_erase_torque>(id);
  }
  return lines;
}

std::string change_questions(const Plan& plan) {
  std::string lines;
  const Values now = plan.before.values();
  for (const Change& change : plan.changes) {
    const Parameter& parameter = *change.parameter;
    if (!plan.erase && change.is_planned() &&
        bla::may_move(parameter.address, change.requested, now)) {
      lines += say<texts::question_change>(
          plan.before.servo.id.value(), parameter.name,
          change.before ? bla::register_text(parameter, *change.before, plan.mode_before)
                        : say<texts::unknown_before>(),
          bla::register_text(parameter, change.requested, plan.mode_after));
    }
  }
  return lines;
}

} // namespace

bool Plan::acts() const {
  return erase || restart || std::ranges::any_of(changes, &Change::is_planned);
}

bool Plan::moves() const {
  const Values now = before.values();
  return erase || restart || std::ranges::any_of(changes, [&](const Change& change) {
           return change.is_planned() &&
                  bla::may_move(change.parameter->address, change.requested, now);
         });
}

std::optional<dronecan::NodeId> Plan::given_node_id() const {
  std::optional<std::int64_t> given;
  for (const Change& change : changes) {
    if (change.parameter->address == at::static_node_id) {
      given = change.requested;
    }
  }
  if (restart == RestartKind::save) {
    given = bla::find(expected, at::static_node_id);
  }
  const bool is_news = given.value_or(0) != 0 && *given != before.servo.id.value();
  return is_news ? std::optional(dronecan::NodeId(static_cast<std::uint8_t>(*given)))
                 : std::nullopt;
}

std::optional<std::int64_t> Plan::given_servo_id() const {
  std::optional<std::int64_t> given;
  for (const Change& change : changes) {
    if (change.parameter->address == at::servo_id) {
      given = change.requested;
    }
  }
  if (restart == RestartKind::save) {
    given = bla::find(expected, at::servo_id);
  }
  return given.value_or(0) != 0 ? given : std::nullopt;
}

Result<std::vector<const Parameter*>> registers_needed(const Wanted& wanted, const Servo& servo) {
  for (const Assignment& assignment : wanted.assignments) {
    const auto allowed =
        servo.identity.may_write(assignment.parameter->address, assignment.value.raw);
    if (!allowed) {
      return std::unexpected(allowed.error());
    }
  }
  if (wanted.is_about_whole_servo() && servo.identity.model().empty()) {
    return fail(Code::no_profile, say<texts::only_readable>(), say<texts::defaults_unknown_hint>());
  }
  Registers registers = to_judge(wanted, servo);
  if (wanted.restart || wanted.erase) { // after the restart all of it must be the same
    for (const Parameter* parameter : servo.identity.configuration()) {
      add(registers, parameter);
    }
  }
  return registers;
}

Result<Plan> make_plan(const Wanted& wanted, Snapshot before, const bla::Profiles& profiles) {
  // For a mere restart nothing rests on single registers.
  const bool needs_values =
      !wanted.is_about_whole_servo() || wanted.erase || wanted.restart != RestartKind::restart;
  if (auto incomplete = needs_values ? before.first_error() : before.error) {
    return std::unexpected(std::move(*incomplete));
  }
  if (before.has_restarted && wanted.restart == RestartKind::save) {
    const std::uint8_t id = before.servo.id.value();
    return std::unexpected(
        Error{Code::state, say<texts::restarted_while_read>(id), say<texts::run_again_hint>(), id});
  }
  if (auto misfit = check_unit(wanted, before, profiles)) {
    return std::unexpected(std::move(*misfit));
  }
  Plan plan{.before = std::move(before),
            .erase = wanted.erase,
            .keep_ids = wanted.keep_ids,
            .restart = wanted.restart};
  if (wanted.erase) {
    auto defaults = plan.before.servo.identity.factory_defaults();
    if (!defaults) {
      return std::unexpected(about(plan.before.servo, std::move(defaults.error())));
    }
    plan.expected = std::move(*defaults);
  }
  plan_changes(wanted, wanted.erase ? plan.expected : plan.before.values(), plan);
  if (wanted.erase && wanted.keep_ids) {
    plan_kept_ids(plan);
  }
  if (auto misfit = check_switches(plan)) {
    return std::unexpected(std::move(*misfit));
  }
  if (plan.erase || plan.restart == RestartKind::save) {
    plan.expected = expected_after(plan);
  }
  plan.warnings = warnings_of(plan);
  return plan;
}

std::optional<Error> refuse_together(const Wanted& wanted,
                                     std::span<const dronecan::NodeId> servos) {
  for (const Assignment& assignment : wanted.assignments) {
    const Parameter& parameter = *assignment.parameter;
    if (wanted.restart == RestartKind::save && !parameter.saved) {
      return Error{Code::usage, say<texts::command_is_not_saved>(parameter.name),
                   say<texts::command_is_not_saved_hint>(), std::nullopt};
    }
    const bool gives_id = assignment.value.raw != 0 && servos.size() > 1;
    if (gives_id && parameter.address == at::static_node_id) {
      return Error{Code::duplicate_node_id, say<texts::one_id_for_several>(servos.size()),
                   say<texts::one_id_for_several_hint>(servos.front().value()), std::nullopt};
    }
    if (gives_id && parameter.address == at::servo_id) {
      return Error{Code::duplicate_servo_id, say<texts::servo_id_for_several>(servos.size()),
                   say<texts::one_id_for_several_hint>(servos.front().value()), std::nullopt};
    }
  }
  return std::nullopt;
}

std::string question(std::span<const Plan> plans) {
  std::string lines;
  bool of_registers = false;
  for (const Plan& plan : plans) {
    of_registers = of_registers || (!plan.erase && !plan.changes.empty());
    lines += plan.erase ? erase_question(plan) : std::string();
    if (plan.restart) { // ERASE and changes come before it
      lines += restart_question(plan);
    }
    lines += change_questions(plan);
  }
  const auto stays_in_ram = [](const Plan& plan) { return plan.erase && !plan.restart; };
  if (std::ranges::any_of(plans, stays_in_ram)) {
    lines += say<texts::question_erase_rom>();
  }
  return lines.empty() || !of_registers ? lines : say<texts::question_may_move>() + lines;
}

} // namespace blactl::fleet
