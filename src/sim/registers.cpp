#include "blactl/sim/registers.hpp"

#include <algorithm>
#include <utility>

namespace blactl::sim {

using bla::Address;
using namespace bla::address;

namespace {

constexpr Address current_temperature{0x0B}, current_voltage{0x0C};
constexpr Address fault_summary{0x18}, fault_notice{0x19}, fault_warning{0x1A}, fault_failure{0x1B};
constexpr Address speed_torque_control{0x25};
constexpr Address last_address{0x5F};

constexpr std::array commands{command_angle, command_speed, command_torque};

/// Room temperature, and a supply inside the default limits of the voltage class.
constexpr std::int64_t room_celsius = 25;

std::int64_t supply_decivolt(std::string_view voltage_class) {
  if (voltage_class == "06U") {
    return 74;
  }
  return voltage_class == "28U" ? 280 : 120;
}

/// 0x58-0x5C: 2025-06-22 15:30.
constexpr std::array production_date{std::pair{Address{0x58}, 2025}, std::pair{Address{0x59}, 6},
                                     std::pair{Address{0x5A}, 22}, std::pair{Address{0x5B}, 15},
                                     std::pair{Address{0x5C}, 30}};

/// -180.0 to +179.9 deg: a servo knows the position in a turn, not the turns (4.1).
std::int64_t within_one_turn(std::int64_t decidegrees) {
  constexpr std::int64_t turn = 3600;
  constexpr std::int64_t half = turn / 2;
  const std::int64_t from_lowest = (decidegrees + half) % turn;
  return (from_lowest < 0 ? from_lowest + turn : from_lowest) - half;
}

/// Requirement 166: a bit for each level and byte (group of causes) of 0x19-0x1B.
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

} // namespace

Registers::Registers(const ServoSetup& setup)
    : profile_(setup.profile), firmware_version_(setup.firmware_version),
      behaviour_(setup.behaviour) {
  power_on(setup);
}

void Registers::power_on(const ServoSetup& setup) {
  for (const bla::Parameter& parameter : profile_->parameters) {
    store(parameter.address, parameter.default_raw.value_or(0));
  }
  store(current_temperature, room_celsius);
  store(current_voltage, supply_decivolt(profile_->voltage_class));
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
}

void Registers::save() {
  for (const bla::Parameter& parameter : profile_->parameters) {
    if (parameter.saved) {
      rom_[parameter.address.value() % count] = value(parameter.address);
    }
  }
}

void Registers::initialize() {
  for (const bla::Parameter& parameter : profile_->parameters) {
    if (parameter.saved || parameter.group == bla::Group::command) {
      store(parameter.address, parameter.default_raw.value_or(0));
    }
  }
}

void Registers::restart() {
  initialize(); // of the commands; what is saved comes from ROM
  for (const bla::Parameter& parameter : profile_->parameters) {
    if (parameter.saved) {
      store(parameter.address, rom_value(parameter.address));
    }
  }
  store(current_angle, within_one_turn(value(current_angle)));
}

void Registers::store(Address address, std::int64_t value) {
  values_[address.value() % count] = value;
}

std::int64_t Registers::value(Address address) const {
  if (address > last_address) {
    return 0;
  }
  if (address == fault_summary) {
    return summary(value(fault_notice), value(fault_warning), value(fault_failure));
  }
  return values_[address.value()];
}

std::int64_t Registers::rom_value(Address address) const {
  return address > last_address ? 0 : rom_[address.value()];
}

/// The register as this model and firmware have it.
const bla::Parameter* Registers::existing(Address address) const {
  const bla::Parameter* parameter = profile_->find(address);
  return parameter != nullptr && parameter->exists_in(firmware_version_) ? parameter : nullptr;
}

std::optional<std::int64_t> Registers::read(Address address) const {
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
bool Registers::disabled_command(Address address) const {
  const bool optional_command = address == command_speed || address == command_torque;
  const bool enabled =
      existing(speed_torque_control) != nullptr && value(speed_torque_control) != 0;
  return optional_command && !enabled && behaviour_.ignores_disabled_commands;
}

std::optional<std::int64_t> Registers::write(Address address, std::int64_t wanted) {
  const bla::Parameter* parameter = existing(address);
  if (parameter == nullptr || !parameter->writable() || address == bootloader) {
    return std::nullopt;
  }
  const std::int64_t low = parameter->min.value_or(wanted);
  const std::int64_t high = parameter->max.value_or(wanted);
  const bool in_range = wanted >= low && wanted <= high;
  if (disabled_command(address) || (!in_range && behaviour_.out_of_range == OutOfRange::refuse)) {
    return value(address);
  }
  const std::int64_t taken = std::clamp(wanted, low, high);
  if (parameter->group == bla::Group::operation) {
    return taken;
  }
  store(address, taken);
  if (std::ranges::find(commands, address) != commands.end()) {
    for (const Address other : commands) {
      if (other != address) {
        store(other, bla::not_active); // requirement 114: one kind of command rules
      }
    }
  }
  return taken;
}

} // namespace blactl::sim
