#include "blactl/sim/servo/memory.hpp"

#include "blactl/sim/servo/world.hpp"

#include "sim/servo/names.hpp"

#include <algorithm>
#include <utility>

namespace blactl::sim {

using namespace address;

namespace {

constexpr Address last_address{0x5F};

/// 0x58-0x5C: 2025-06-22 15:30.
constexpr std::array production_date{std::pair{Address{0x58}, 2025}, std::pair{Address{0x59}, 6},
                                     std::pair{Address{0x5A}, 22}, std::pair{Address{0x5B}, 15},
                                     std::pair{Address{0x5C}, 30}};

/// Requirement 166: one bit for each level and byte (group of causes) of 0x19-0x1B.
std::int64_t summary(std::int64_t notice, std::int64_t warning, std::int64_t failure) {
  const std::array levels{notice, warning, failure};
  std::int64_t bits = 0;
  for (unsigned group = 0; group < 4; ++group) {
    for (unsigned level = 0; level < levels.size(); ++level) {
      const bool any = ((levels[level] >> (8 * group)) & 0xFF) != 0;
      bits |= std::int64_t{any} << (8 * group + level);
    }
  }
  return bits;
}

bool in_range(const bla::Parameter& parameter, std::int64_t wanted) {
  return wanted >= parameter.min.value_or(wanted) && wanted <= parameter.max.value_or(wanted);
}

std::int64_t nearest(const bla::Parameter& parameter, std::int64_t wanted) {
  return std::clamp(wanted, parameter.min.value_or(wanted), parameter.max.value_or(wanted));
}

} // namespace

Memory::Memory(const ServoSetup& setup)
    : profile_(setup.profile), firmware_version_(setup.firmware_version),
      behaviour_(setup.behaviour) {
  power_on(setup);
}

void Memory::power_on(const ServoSetup& setup) {
  for (const bla::Parameter& parameter : profile_->parameters) {
    store(parameter.address, parameter.default_raw.value_or(0));
  }
  store(current_temperature, World::room_celsius);
  store(current_voltage, nominal_decivolt(setup));
  for (const auto& [address, value] : production_date) {
    store(address, value);
  }
  store(servo_id, setup.servo_id);
  store(static_node_id, setup.node_id);
  store(model_number, setup.model_number);
  store(serial_number, setup.serial_number);
  store(firmware_version, setup.firmware_version);
  store(hardware_version, setup.hardware_version);
  for (const auto& [address, value] : setup.rom) {
    store(address, value);
  }
  save();
  for (const auto& [address, value] : setup.ram) {
    store(address, value);
  }
  start();
}

void Memory::save() {
  for (const bla::Parameter& parameter : profile_->parameters) {
    if (parameter.saved) {
      rom_[parameter.address.value() % count] = value(parameter.address);
    }
  }
}

void Memory::initialize() {
  for (const bla::Parameter& parameter : profile_->parameters) {
    if (parameter.saved || parameter.group == bla::Group::command) {
      store(parameter.address, parameter.default_raw.value_or(0));
    }
  }
}

void Memory::erase() {
  initialize();
  if (behaviour_.erase_clears_rom) {
    save();
  }
}

void Memory::restart() {
  initialize(); // for the commands; saved registers come from ROM
  for (const bla::Parameter& parameter : profile_->parameters) {
    if (parameter.saved) {
      store(parameter.address, rom_value(parameter.address));
    }
  }
}

void Memory::store(Address address, std::int64_t value) {
  values_[address.value() % count] = value;
}

std::int64_t Memory::value(Address address) const {
  if (address > last_address) {
    return 0;
  }
  if (address == fault_summary) {
    return summary(value(fault_notice), value(fault_warning), value(fault_failure));
  }
  return values_[address.value()];
}

std::int64_t Memory::in_effect(Address address) const {
  const bool waits =
      address == reverse || address == timeout_time || address == origin || address == servo_id;
  return waits && behaviour_.settings_wait_for_start ? at_start_[address.value() % count]
                                                     : value(address);
}

std::int64_t Memory::rom_value(Address address) const {
  return address > last_address ? 0 : rom_[address.value()];
}

const bla::Parameter* Memory::existing(Address address) const {
  const bla::Parameter* parameter = profile_->find(address);
  return parameter != nullptr && parameter->exists_in(firmware_version_) ? parameter : nullptr;
}

std::optional<std::int64_t> Memory::read(Address address) const {
  const auto missing = [](MissingRead answer) {
    return answer == MissingRead::zero ? std::optional<std::int64_t>(0) : std::nullopt;
  };
  if (address > last_address) {
    return std::nullopt;
  }
  const bla::Parameter* parameter = profile_->find(address);
  if (parameter == nullptr) {
    return missing(behaviour_.reserved_reads);
  }
  if (!parameter->exists_in(firmware_version_)) {
    return missing(behaviour_.gated_reads);
  }
  return parameter->readable() ? std::optional(value(address))
                               : missing(behaviour_.write_only_reads);
}

/// Requirement 117: without 0x25 (or with a firmware that lacks it) speed and torque commands are
/// ignored.
bool Memory::disabled_command(Address address) const {
  const bool optional_command = address == command_speed || address == command_torque;
  const bool acts = acts_with_speed_control_ && existing(speed_torque_control) != nullptr;
  return optional_command && !acts && !controls_speed() && behaviour_.ignores_disabled_commands;
}

bool Memory::controls_speed() const {
  return existing(speed_torque_control) != nullptr ? value(speed_torque_control) != 0
                                                   : behaviour_.speed_control_before_1100;
}

/// Requirement 78: a refused value may get a failure as response.
bool Memory::fails(const bla::Parameter& parameter, std::int64_t wanted) const {
  return behaviour_.out_of_range == OutOfRange::fail && !in_range(parameter, wanted);
}

bool Memory::takes(Address address, std::int64_t wanted) const {
  const bla::Parameter* parameter = existing(address);
  if (parameter == nullptr || !parameter->writable() || address == bootloader ||
      disabled_command(address)) {
    return false;
  }
  return in_range(*parameter, wanted) || behaviour_.out_of_range == OutOfRange::clamp;
}

std::optional<std::int64_t> Memory::write(Address address, std::int64_t wanted) {
  const bla::Parameter* parameter = existing(address);
  if (parameter == nullptr || !parameter->writable() || address == bootloader) {
    return std::nullopt;
  }
  if (!takes(address, wanted)) {
    return fails(*parameter, wanted) ? std::nullopt : std::optional(value(address));
  }
  if (parameter->group == bla::Group::command) {
    command(address, wanted);
    return value(address);
  }
  const std::int64_t taken = nearest(*parameter, wanted);
  if (parameter->group != bla::Group::operation) {
    store(address, taken);
  }
  return taken;
}

std::optional<std::int64_t> Memory::from_array(Address address, std::int64_t wanted) const {
  const bla::Parameter* parameter = existing(address);
  const bool clamps = behaviour_.array_out_of_range == ArrayOutOfRange::clamp;
  if (parameter == nullptr || disabled_command(address) ||
      (!clamps && !in_range(*parameter, wanted))) {
    return std::nullopt;
  }
  return nearest(*parameter, wanted);
}

void Memory::command(Address address, std::int64_t wanted) {
  for (const Address other : bla::command_registers) {
    store(other, bla::not_active);
  }
  store(address, nearest(*profile_->find(address), wanted));
}

} // namespace blactl::sim
