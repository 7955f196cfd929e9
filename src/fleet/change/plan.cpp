#include "blactl/fleet/change/plan.hpp"

#include "blactl/bla/cross_check.hpp"
#include "blactl/bla/effect.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include "fleet/change/texts.hpp"

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

/// The registers to be written, 0x37 for the unit of 0x36, and those that show whether a change
/// moves the shaft.
Registers to_judge(const Wanted& wanted, const Servo& servo) {
  Registers registers;
  for (const Assignment& assignment : wanted.assignments) {
    add(registers, servo.identity.parameter(assignment.parameter->address));
  }
  for (const Assignment& assignment : wanted.assignments) {
    if (bla::unit_depends_on_mode(*assignment.parameter)) {
      add(registers, servo.identity.parameter(at::pwm_mode));
    }
    const auto needed = bla::values_needed(assignment.parameter->address);
    for (const Parameter* parameter : servo.identity.registers(needed)) {
      add(registers, parameter);
    }
  }
  return registers;
}

Error about(const Servo& servo, Error error) {
  error.node_id = servo.id.value();
  error.message = say<texts::about_node>(servo.id.value(), error.message);
  return error;
}

/// The output is switched off before limits change, and on after them. A command may need a switch
/// that is set with it.
int turn_of(const RegisterChange& change) {
  const Address address = change.parameter->address;
  const bool stops = (address == at::command_speed || address == at::command_torque) &&
                     change.requested == 0 && change.is_planned();
  if (stops) { // whatever else is to be written, it does not turn on meanwhile
    return -1;
  }
  const bool is_switch = change.parameter->address == at::torque_output;
  const bool is_command = change.parameter->group == bla::Group::command;
  return is_command ? 3 : !is_switch ? 1 : change.requested == 0 ? 2 : 0; // 0: on (4.13)
}

/// As the output goes on, the servo discards the command that it was given before (4.13).
void renew_commands(std::vector<RegisterChange>& changes) {
  const bool goes_on = std::ranges::any_of(changes, [](const RegisterChange& change) {
    return change.parameter->address == at::torque_output && change.requested == 0 &&
           change.is_planned();
  });
  for (RegisterChange& change : changes) {
    if (goes_on && change.parameter->group == bla::Group::command) {
      change.status = ChangeStatus::planned;
    }
  }
}

/// `held`: the values when the changes are made.
void plan_changes(const Wanted& wanted, const Values& held, Plan& plan) {
  for (const Assignment& assignment : wanted.assignments) {
    const Address address = assignment.parameter->address;
    plan.changes.push_back(change_from(bla::find(held, address),
                                       plan.before.servo.identity.parameter(address),
                                       assignment.value.raw));
  }
  renew_commands(plan.changes);
  std::ranges::stable_sort(plan.changes, {}, turn_of);
  plan.mode_before = plan.mode_after = bla::find(held, at::pwm_mode);
  for (const RegisterChange& change : plan.changes) {
    if (change.parameter->address == at::pwm_mode) {
      plan.mode_after = change.requested;
    }
  }
}

/// Visits every change to be made in the form for cross-checks, in the order asked.
template <class Visit> void for_each_proposal(const Plan& plan, Visit visit) {
  const Values before = plan.before.values();
  Values after = before;
  for (const RegisterChange& change : plan.changes) {
    after[change.parameter->address] = change.requested;
  }
  for (const RegisterChange& change : plan.changes) {
    if (change.is_planned()) {
      visit(change, bla::Proposal{.address = change.parameter->address,
                                  .requested = change.requested,
                                  .before = before,
                                  .after = after,
                                  .servo = plan.before.servo.identity});
    }
  }
}

std::string_view reason(const bla::CrossCheck& check) {
  return choose(check.reason.en, check.reason.ja);
}

/// "angle_dead_band=0.0deg: …"
std::string judgement(const Plan& plan, const RegisterChange& change,
                      const bla::CrossCheck& check) {
  const Parameter& parameter = *change.parameter;
  return say<texts::judged_change>(
      parameter.name, bla::input_text(parameter, change.requested, plan.mode_after), reason(check));
}

std::optional<Error> check_together(const Plan& plan) {
  const std::uint8_t id = plan.before.servo.id.value();
  std::optional<Error> refused;
  for_each_proposal(plan, [&](const RegisterChange& change, const bla::Proposal& proposal) {
    for (const auto* check : met(bla::CheckKind::refusal, proposal)) {
      if (!refused) {
        refused = Error{
            Code::cross_check, say<texts::about_node>(id, judgement(plan, change, *check)),
            check->remedy.empty() ? std::string() : say<texts::set_first_hint>(id, check->remedy),
            id};
      }
    }
  });
  return refused;
}

/// Each kind once, for the first change with it.
std::vector<Warning> warnings_of(const Plan& plan) {
  std::vector<Warning> warnings;
  for_each_proposal(plan, [&](const RegisterChange& change, const bla::Proposal& proposal) {
    for (const auto* check : met(bla::CheckKind::warning, proposal)) {
      if (std::ranges::find(warnings, check->code, &Warning::code) == warnings.end()) {
        warnings.push_back({std::string(check->code), judgement(plan, change, *check)});
      }
    }
  });
  return warnings;
}

/// --keep-ids: writes 0x45 and 0x46 back into RAM, unless other values are wanted. A 0 is 0 after
/// ERASE anyway.
Result<void> plan_kept_ids(const Values& lost_ids, Plan& plan) {
  for (const Address address : {at::servo_id, at::static_node_id}) {
    const auto lost = bla::find(lost_ids, address);
    const auto kept = lost ? lost : plan.before.raw(address);
    const Parameter* parameter = plan.before.servo.identity.parameter(address);
    if (kept.value_or(0) != 0 && parameter != nullptr && plan.change_of(address) == nullptr) {
      if (auto allowed = plan.before.servo.identity.may_write(address, *kept); !allowed) {
        return std::unexpected(about(plan.before.servo, std::move(allowed.error())));
      }
      plan.changes.push_back({.parameter = parameter, .requested = *kept, .before = 0});
    }
  }
  return {};
}

/// The final configuration, as far as it will be proven.
Values expected_after(const Plan& plan) {
  Values expected = plan.expected; // after ERASE
  if (!plan.erase) {
    for (const Parameter* parameter : plan.before.servo.identity.configuration()) {
      if (const auto raw = plan.before.raw(parameter->address)) {
        expected[parameter->address] = *raw;
      }
    }
  }
  for (const RegisterChange& change : plan.changes) {
    if (change.parameter->saved) {
      expected[change.parameter->address] = change.requested;
    }
  }
  return expected;
}

template <const Text& one, const Text& several>
std::string restart_question(std::span<const dronecan::NodeId> servos) {
  return servos.empty()       ? std::string()
         : servos.size() == 1 ? say<one>(servos.front().value())
                              : say<several>(id_list(servos));
}

/// What the servos do at their restarts, those that do the same in one line.
std::string restart_questions(std::span<const Plan> plans) {
  std::vector<dronecan::NodeId> unknown, softly, hard;
  for (const Plan& plan : plans) {
    const bool is_known = plan.restart != RestartKind::restart; // SAVE keeps what is in RAM
    const auto motion = bla::restart_motion(plan.expected);
    if (!plan.restart || (is_known && motion == bla::RestartMotion::none)) {
      continue;
    }
    const bool is_soft = motion == bla::RestartMotion::soft;
    (!is_known ? unknown : is_soft ? softly : hard).push_back(plan.before.servo.id);
  }
  for (auto* servos : {&unknown, &softly, &hard}) {
    std::ranges::sort(*servos);
  }
  return restart_question<texts::question_restart_unknown, texts::question_restarts_unknown>(
             unknown) +
         restart_question<texts::question_restart_soft, texts::question_restarts_soft>(softly) +
         restart_question<texts::question_restart_hard, texts::question_restarts_hard>(hard);
}

/// The effect of erasing this servo.
std::string erase_question(const Plan& plan) {
  const auto id_text = [&](Address address) {
    const auto raw = plan.before.raw(address);
    return raw ? std::to_string(*raw) : say<texts::unknown_before>();
  };
  const std::uint8_t id = plan.before.servo.id.value();
  std::string lines = plan.keep_ids ? say<texts::question_erase_keep>(id)
                                    : say<texts::question_erase>(id, id_text(at::servo_id),
                                                                 id_text(at::static_node_id));
  // by default torque is on (4.13)
  if (bla::restart_motion(plan.before.values()) == bla::RestartMotion::none) {
    lines += say<texts::question_erase_torque>(id);
  }
  return lines;
}

/// A change may need confirmation for several reasons.
std::string change_question(const Plan& plan, const RegisterChange& change,
                            std::span<const bla::CrossCheck* const> checks) {
  const Parameter& parameter = *change.parameter;
  std::string line = say<texts::question_change>(
      plan.before.servo.id.value(), parameter.name,
      change.before ? bla::register_text(parameter, *change.before, plan.mode_before)
                    : say<texts::unknown_before>(),
      bla::register_text(parameter, change.requested, plan.mode_after));
  for (const bla::CrossCheck* check : checks) {
    line += check->code == bla::always_asked ? std::string()
                                             : say<texts::question_reason>(reason(*check));
  }
  return line;
}

std::string change_questions(const Plan& plan) {
  std::string lines;
  for_each_proposal(plan, [&](const RegisterChange& change, const bla::Proposal& proposal) {
    const auto checks = met(bla::CheckKind::question, proposal);
    if (!plan.erase && !checks.empty()) {
      lines += change_question(plan, change, checks);
    }
  });
  return lines;
}

/// By SAVE the value kept, else the one to be written; empty: none.
std::optional<std::int64_t> value_given(const Plan& plan, Address address) {
  if (plan.restart == RestartKind::save) {
    return bla::find(plan.expected, address);
  }
  const RegisterChange* change = plan.change_of(address);
  return change != nullptr ? std::optional(change->requested) : std::nullopt;
}

} // namespace

const RegisterChange* Plan::change_of(Address address) const {
  for (const RegisterChange& change : changes) {
    if (change.parameter->address == address) {
      return &change;
    }
  }
  return nullptr;
}

bool Plan::acts() const {
  return erase || restart || std::ranges::any_of(changes, &RegisterChange::is_planned);
}

bool Plan::waits_for_driver() const {
  bool waits = erase || restart || never_while_driven;
  for_each_proposal(*this, [&](const RegisterChange&, const bla::Proposal& proposal) {
    waits = waits || bla::may_move(proposal);
  });
  return waits;
}

std::optional<dronecan::NodeId> Plan::given_node_id() const {
  const auto given = value_given(*this, at::static_node_id);
  const bool is_news = given.value_or(0) != 0 && *given != before.servo.id.value();
  return is_news ? std::optional(dronecan::NodeId(static_cast<std::uint8_t>(*given)))
                 : std::nullopt;
}

std::optional<std::int64_t> Plan::given_servo_id() const {
  const bool brings_other =
      restart == RestartKind::restart && rom_servo_id != before.raw(at::servo_id);
  const auto given = brings_other ? rom_servo_id : value_given(*this, at::servo_id);
  return given.value_or(0) != 0 ? given : std::nullopt;
}

std::vector<std::int64_t> Plan::next_servo_ids() const {
  std::vector<std::int64_t> ids;
  if (erase) {
    ids.push_back(0);
  }
  for (const auto id : {value_given(*this, at::servo_id), rom_servo_id}) {
    if (id) {
      ids.push_back(*id);
    }
  }
  return ids;
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
  for (const Parameter* parameter : servo.identity.registers(wanted.also_read)) {
    add(registers, parameter);
  }
  if (wanted.restart || wanted.erase) { // after the restart all of it must be the same
    for (const Parameter* parameter : servo.identity.configuration()) {
      add(registers, parameter);
    }
  }
  const bool keeps_rom = !wanted.erase || wanted.keep_ids;
  if (wanted.restart && keeps_rom) { // SAVE replaces what was not read, a restart may read it
    add(registers, rom_state(servo.identity));
  }
  return registers;
}

Result<Plan> make_plan(const Wanted& wanted, Snapshot before, const bla::Profiles& profiles) {
  // a plain restart does not depend on single registers
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
  if (auto misfit = check_unit(wanted.assignments, before, profiles)) {
    return std::unexpected(std::move(*misfit));
  }
  Plan plan{.before = std::move(before),
            .erase = wanted.erase,
            .keep_ids = wanted.keep_ids,
            .restart = wanted.restart,
            .proves_rom = wanted.proves_rom,
            .never_while_driven = wanted.never_while_driven,
            .rom_servo_id = wanted.rom_servo_id,
            .told_until = wanted.told_until,
            .shown = wanted.also_read};
  if (wanted.erase) {
    auto defaults = plan.before.servo.identity.factory_defaults();
    if (!defaults) {
      return std::unexpected(about(plan.before.servo, std::move(defaults.error())));
    }
    plan.expected = std::move(*defaults);
  }
  plan_changes(wanted, wanted.erase ? plan.expected : plan.before.values(), plan);
  if (wanted.erase && wanted.keep_ids) {
    if (auto kept = plan_kept_ids(wanted.lost_ids, plan); !kept) {
      return std::unexpected(std::move(kept.error()));
    }
  }
  if (auto refused = check_together(plan)) {
    return std::unexpected(std::move(*refused));
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
    lines += change_questions(plan);
  }
  lines += restart_questions(plans); // ERASE and changes come before them
  const auto stays_in_ram = [](const Plan& plan) { return plan.erase && !plan.restart; };
  if (std::ranges::any_of(plans, stays_in_ram)) {
    lines += say<texts::question_erase_rom>();
  }
  const bool is_about_registers = !lines.empty() && of_registers;
  return is_about_registers ? say<texts::question_may_move>() + lines : lines;
}

} // namespace blactl::fleet
