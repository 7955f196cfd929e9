#include "blactl/bla/assignment.hpp"

#include "blactl/base/text.hpp"

#include "bla/texts.hpp"
#include "bla/words.hpp"

#include <algorithm>
#include <utility>

namespace blactl::bla {
namespace {

Result<void> check_access(const Parameter& parameter) {
  if (parameter.address == address::bootloader) {
    return fail(Code::unsupported, say<texts::bootloader_refused>(), say<texts::parameter_list>());
  }
  if (!parameter.writable()) {
    return fail(Code::read_only, say<texts::is_read_only>(parameter.name, parameter.address.name()),
                say<texts::is_read_only_hint>(parameter.name));
  }
  return {};
}

/// Refuses 0x10-0x12, too, which have their own commands.
Result<void> check_settable(const Parameter& parameter) {
  auto allowed = check_access(parameter);
  if (!allowed || parameter.group != Group::operation) {
    return allowed;
  }
  return fail(Code::unsupported,
              say<texts::operation_refused>(parameter.name, parameter.address.name()),
              say<texts::operation_hint>(operation_command(parameter.address)));
}

/// Checks 0x36 against a 0x37 beside it.
Result<void> check_pwm_pair(const Profiles& profiles, std::span<const Assignment> assignments) {
  const auto by_address = [&](Address address) {
    return std::ranges::find_if(
        assignments, [&](const Assignment& each) { return each.parameter->address == address; });
  };
  const auto range = by_address(address::pwm_output_range);
  const auto mode = by_address(address::pwm_mode);
  if (range == assignments.end() || mode == assignments.end()) {
    return {};
  }
  return check_pwm_unit(profiles, *range, mode->value.raw);
}

/// Suggests the typed number in the unit of `pwm_mode`, if possible (the register number would be
/// ten times off), or as typed with the mode that fits its unit.
std::string ways_to_agree(const Parameter& mode, const Assignment& assignment,
                          std::int64_t pwm_mode) {
  const Parameter& range = *assignment.parameter;
  const std::int64_t raw = pwm_mode == pwm_angle_mode ? assignment.value.raw * range.steps_per_unit
                                                      : assignment.value.raw / range.steps_per_unit;
  const auto wanted = assignment.value.pwm_mode;
  const std::string other =
      fmt::format("{}={} {}={}", mode.name, input_text(mode, *wanted), range.name,
                  input_text(range, assignment.value.raw, wanted));
  return check_range(range, raw) ? say<texts::pwm_either_unit>(
                                       range.name + '=' + input_text(range, raw, pwm_mode), other)
                                 : say<texts::value_type>(other);
}

/// Refuses a number in the unit of another mode, with `message`.
template <const Text& message>
Result<void> check_unit_of_mode(const Profiles& profiles, const Assignment& assignment,
                                std::int64_t pwm_mode) {
  if (assignment.value.pwm_mode.value_or(pwm_mode) == pwm_mode) {
    return {};
  }
  const Parameter& mode = *profiles.find(address::pwm_mode);
  return fail(Code::usage,
              say<message>(printable(assignment.text), mode.name + '=' + input_text(mode, pwm_mode),
                           unit_text(*assignment.parameter, pwm_mode)),
              ways_to_agree(mode, assignment, pwm_mode));
}

/// Refuses several commands at once, since each makes the others inactive (4.1-4.3).
Result<void> check_commands(std::span<const Assignment> assignments) {
  const auto commands = std::ranges::count_if(assignments, [](const Assignment& assignment) {
    return assignment.parameter->can_be_inactive;
  });
  return commands > 1 ? fail(Code::cross_check, say<texts::one_command_only>(),
                             say<texts::one_command_only_hint>())
                      : Result<void>();
}

} // namespace

std::string_view operation_command(Address operation) {
  return operation == address::initialize ? "erase"
         : operation == address::reboot   ? "restart"
                                          : "save";
}

Result<void> never_sent(const Parameter& parameter, std::int64_t raw) {
  if (auto allowed = check_access(parameter); !allowed) {
    return allowed;
  }
  if (parameter.address == address::static_node_id && (raw == 126 || raw == 127)) {
    return fail(Code::out_of_range,
                say<texts::node_id_of_tools>(parameter.name + '=' + std::to_string(raw)),
                say<texts::node_id_hint>());
  }
  return {};
}

std::string remark(const Parameter& parameter) {
  return parameter.address == address::static_node_id ? say<texts::node_ids_of_tools_remark>()
                                                      : std::string();
}

Result<void> check_pwm_unit(const Profiles& profiles, const Assignment& assignment,
                            std::int64_t pwm_mode) {
  return check_unit_of_mode<texts::pwm_unit_against_mode>(profiles, assignment, pwm_mode);
}

Result<void> check_pwm_unit_of_servo(const Profiles& profiles, const Assignment& assignment,
                                     std::int64_t pwm_mode) {
  return check_unit_of_mode<texts::pwm_unit_against_servo>(profiles, assignment, pwm_mode);
}

Result<void> allowed_by_some_model(const Profiles& profiles, const Parameter& parameter,
                                   const TypedValue& value) {
  std::vector<std::string> ranges;
  for (const Profile& profile : profiles.all()) {
    const Parameter* one = profile.find(parameter.address);
    if (one == nullptr || !one->min || !one->max) {
      continue;
    }
    if (check_range(*one, value.raw)) {
      return {};
    }
    if (!profile.takes(*one)) { // nothing to choose from
      continue;
    }
    std::string range = say<texts::value_one_range>(input_text(*one, *one->min, value.pwm_mode),
                                                    input_text(*one, *one->max, value.pwm_mode));
    if (std::ranges::find(ranges, range) == ranges.end()) {
      ranges.push_back(std::move(range));
    }
  }
  auto outside = check_range(parameter, value.raw, value.pwm_mode);
  if (outside) {
    outside = fail(Code::out_of_range,
                   say<texts::value_in_a_gap>(parameter.name + '=' +
                                              input_text(parameter, value.raw, value.pwm_mode)));
  }
  if (parameter.group == Group::pwm) { // other models accept no value
    outside.error().hint = say<texts::pwm_models_take>(either(ranges));
  } else if (ranges.size() > 1) { // no single servo accepts their union
    outside.error().hint = say<texts::value_ranges_hint>(either(ranges));
  }
  return outside;
}

Result<void> allowed_by_model(const Profile& model, const Assignment& assignment) {
  const Parameter& parameter = *assignment.parameter;
  const Parameter* own = model.find(parameter.address);
  if (own == nullptr) {
    return fail(Code::unsupported,
                say<texts::model_lacks>(model.model, parameter.name, parameter.address.name()),
                say<texts::parameter_list>());
  }
  auto within = check_range(*own, assignment.value.raw, assignment.value.pwm_mode);
  if (!within && own->group == Group::pwm && !model.pwm) {
    return fail(Code::unsupported,
                say<texts::no_pwm_parameter>(model.model, parameter.name, parameter.address.name()),
                say<texts::no_pwm_input_hint>(model.model));
  }
  if (!within) {
    within.error().message = model.model + ": " + within.error().message;
  }
  return within;
}

Result<Assignment> make_assignment(const Profiles& profiles, std::string_view parameter,
                                   std::string_view value) {
  const auto found = profiles.find(parameter);
  if (!found) {
    return std::unexpected(found.error());
  }
  Assignment assignment;
  assignment.parameter = *found;
  assignment.named = find_address(parameter) ? NamedBy::address : NamedBy::name;
  assignment.text = std::string(parameter) + '=' + std::string(value);
  const auto may_be_set = check_settable(**found);
  const auto typed = may_be_set ? parse_value(**found, assignment.named, value)
                                : std::unexpected(may_be_set.error());
  if (!typed) {
    return std::unexpected(typed.error());
  }
  assignment.value = *typed;
  auto allowed = allowed_by_some_model(profiles, **found, *typed);
  allowed = allowed ? never_sent(**found, typed->raw) : allowed;
  return allowed ? Result<Assignment>(std::move(assignment)) : std::unexpected(allowed.error());
}

Result<Assignment> parse_assignment(const Profiles& profiles, std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    const auto known = profiles.find(text);
    return fail(Code::usage, say<texts::assignment_without_equals>(printable(text)),
                known && (*known)->writable()
                    ? example_text(**known)
                    : say<texts::assignment_example>("angle_limit_cw=90deg"));
  }
  return make_assignment(profiles, text.substr(0, equals), text.substr(equals + 1));
}

std::expected<std::vector<Assignment>, std::vector<Error>>
parse_assignments(const Profiles& profiles, std::span<const std::string> texts) {
  std::vector<Assignment> assignments;
  std::vector<Error> faults;
  const auto take = [&](Result<void> checked) {
    if (!checked) {
      faults.push_back(std::move(checked.error()));
    }
  };
  for (const std::string& text : texts) {
    auto assignment = parse_assignment(profiles, text);
    if (!assignment) {
      faults.push_back(std::move(assignment.error()));
      continue;
    }
    if (std::ranges::find(assignments, assignment->parameter, &Assignment::parameter) !=
        assignments.end()) {
      take(fail(Code::usage, say<texts::assigned_twice>(assignment->parameter->name),
                say<texts::assigned_twice_hint>()));
    }
    assignments.push_back(std::move(*assignment));
  }
  take(check_pwm_pair(profiles, assignments));
  take(check_commands(assignments));
  if (!faults.empty()) {
    return std::unexpected(std::move(faults));
  }
  return assignments;
}

} // namespace blactl::bla
