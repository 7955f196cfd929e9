#include "fleet/doctor/motion_facts.hpp"

#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/faults.hpp"
#include "blactl/bla/value.hpp"

#include "fleet/doctor/motion_texts.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;

std::optional<std::int64_t> MotionFacts::held(Address reg) const {
  return bla::find(values_, reg);
}

MotionFacts::Control MotionFacts::control() const {
  const bla::Parameter* known = servo_.identity.parameter(at::speed_torque_control);
  if (known != nullptr && !servo_.identity.has(*known)) {
    return Control::missing;
  }
  const auto raw = held(at::speed_torque_control);
  return !raw ? Control::unknown : *raw == 0 ? Control::off : Control::on;
}

MotionFacts::Pulses MotionFacts::pulses() const {
  const bla::Profile* profile = servo_.identity.profile();
  const auto notices = bla::fault_register(values_, at::fault_notice);
  if (profile == nullptr || !profile->pwm || !notices || !servo_.identity.check_pwm_input()) {
    return Pulses::unknown;
  }
  namespace fault = bla::fault;
  return (*notices & fault::pwm_missing) != 0     ? Pulses::none
         : (*notices & fault::pwm_too_short) != 0 ? Pulses::too_short
         : (*notices & fault::pwm_too_long) != 0  ? Pulses::too_long
                                                  : Pulses::valid;
}

bool MotionFacts::has_pulses() const {
  const Pulses at_input = pulses();
  return at_input != Pulses::unknown && at_input != Pulses::none;
}

bool MotionFacts::is_commanded() const {
  return !heard_.to_it.empty();
}

bool MotionFacts::is_asked_only(Address reg) const {
  if (is_commanded()) {
    return std::ranges::all_of(heard_.to_it, [&](const HeardCommands::Stream& stream) {
      return stream.command.asked && stream.command.asked->reg == reg;
    });
  }
  return std::ranges::all_of(bla::command_registers, [&](Address each) {
    const auto raw = held(each);
    return raw && (*raw == bla::not_active) == (each != reg);
  });
}

/// "timeout_time=1000ms"
std::string MotionFacts::setting(Address reg, std::optional<std::int64_t> raw) const {
  const bla::Parameter* known = servo_.identity.parameter(reg);
  if (known == nullptr) {
    return reg.name();
  }
  return known->name + '=' +
         (raw ? bla::input_text(*known, *raw, held(at::pwm_mode)) : std::string("VALUE"));
}

/// Unless it is known to be in RAM only.
bool MotionFacts::is_in_rom(Address reg) const {
  const auto stored = bla::find(rom_, reg);
  return !stored || stored == held(reg);
}

/// What is in ROM would be back after the next start.
std::string MotionFacts::command(const std::string& settings,
                                 std::span<const Address> registers) const {
  const bool saves = std::ranges::any_of(registers, [this](Address reg) { return is_in_rom(reg); });
  return say<texts::motion_set>(servo_.id.value(), settings, saves ? " --save" : "");
}

std::string MotionFacts::when_stopped(std::string command) const {
  return is_commanded() ? say<texts::motion_when_stopped>(heard_.to_it.front().by.value(), command)
                        : std::move(command);
}

std::string MotionFacts::set(Address reg, std::optional<std::int64_t> raw) const {
  return when_stopped(command(setting(reg, raw), std::array{reg}));
}

std::string MotionFacts::set_defaults(std::span<const Address> registers) const {
  return when_stopped(defaults_command(registers));
}

std::string MotionFacts::defaults_command(std::span<const Address> registers) const {
  std::string list;
  for (const Address reg : registers) {
    const bla::Parameter* known = servo_.identity.parameter(reg);
    list += (list.empty() ? "" : " ") +
            setting(reg, known != nullptr ? known->default_raw : std::nullopt);
  }
  return command(list, registers);
}

std::string MotionFacts::shown(Address reg, std::int64_t raw) const {
  const bla::Parameter* known = servo_.identity.parameter(reg);
  return known != nullptr ? bla::display(*known, raw) : std::to_string(raw);
}

std::string MotionFacts::name_of(Address reg) const {
  const bla::Parameter* known = servo_.identity.parameter(reg);
  return known != nullptr ? known->name : reg.name();
}

std::string MotionFacts::listed(std::span<const Address> registers) const {
  std::string list;
  for (const Address reg : registers) {
    list += (list.empty() ? "" : ", ") + name_of(reg) + ' ' + shown(reg, held(reg).value_or(0));
  }
  return list;
}

std::string MotionFacts::timeout_text() const {
  const auto action = held(at::timeout_action);
  return action == 1   ? say<texts::motion_timeout_off>()
         : action == 2 ? say<texts::motion_timeout_brake>()
                       : std::string();
}

} // namespace blactl::fleet
