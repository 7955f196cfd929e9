#include "sim/servo/protection.hpp"

#include "sim/servo/names.hpp"
#include "sim/servo/soft_start.hpp"

#include <array>

namespace blactl::sim {
namespace {

/// A reading and the two limits that it is compared with.
struct Range {
  bla::Address reading, upper, lower;
  std::int64_t upper_bit, lower_bit;
};

constexpr std::array notices{
    Range{address::current_angle, address::angle_limit_cw, address::angle_limit_ccw,
          fault::angle_cw, fault::angle_ccw},
    Range{address::current_speed, address::speed_limit_cw, address::speed_limit_ccw,
          fault::speed_cw, fault::speed_ccw},
    Range{address::current_torque, address::torque_limit_cw, address::torque_limit_ccw,
          fault::torque_cw, fault::torque_ccw},
};

constexpr std::array warnings{
    Range{address::current_temperature, address::temperature_limit_high,
          address::temperature_limit_low, fault::temperature_high, fault::temperature_low},
    Range{address::current_voltage, address::voltage_limit_high, address::voltage_limit_low,
          fault::voltage_high, fault::voltage_low},
};

bool beyond(std::int64_t value, std::int64_t upper, std::int64_t lower, bool inclusive) {
  return inclusive ? value >= upper || value <= lower : value > upper || value < lower;
}

template <std::size_t size>
std::int64_t bits_of(const std::array<Range, size>& ranges, const Memory& registers, bool inclusive,
                     bool soft_start = false) {
  const auto limit = [&](bla::Address address) {
    const auto temporary = soft_start ? soft_start_value(address) : std::nullopt;
    return temporary.value_or(registers.value(address));
  };
  std::int64_t bits = 0;
  for (const Range& range : ranges) {
    const std::int64_t reading = registers.value(range.reading);
    const std::int64_t upper = limit(range.upper);
    const std::int64_t lower = limit(range.lower);
    bits |= reading > upper || (inclusive && reading == upper) ? range.upper_bit : 0;
    bits |= reading < lower || (inclusive && reading == lower) ? range.lower_bit : 0;
  }
  return bits;
}

/// 4.31: a command beyond a limit, or at it if Behaviour says so (4.12), is shown as well, although
/// the shaft stays inside.
std::int64_t commanded_beyond(const Memory& registers, bool inclusive) {
  const std::int64_t command = registers.value(address::command_angle);
  if (command == bla::not_active) {
    return 0;
  }
  const std::int64_t most = registers.value(address::angle_limit_cw);
  const std::int64_t least = registers.value(address::angle_limit_ccw);
  const bool cw = command > most || (inclusive && command == most);
  const bool ccw = command < least || (inclusive && command == least);
  return (cw ? fault::angle_cw : 0) | (ccw ? fault::angle_ccw : 0);
}

std::int64_t of_magnet(Magnet magnet, Magnet state, std::int64_t bit) {
  return magnet == state ? bit : 0;
}

} // namespace

Faults present_faults(const Memory& registers, const World& world, const Behaviour& behaviour,
                      bool soft_start) {
  Faults faults{world.notices, world.warnings, world.failures};
  faults.notice |= bits_of(notices, registers, behaviour.inclusive_limits, soft_start);
  faults.notice |= commanded_beyond(registers, behaviour.command_at_limit_notifies);
  faults.warning |= bits_of(warnings, registers, behaviour.inclusive_limits);
  faults.warning |= of_magnet(world.magnet, Magnet::weak, fault::magnet_weak);
  faults.warning |= of_magnet(world.magnet, Magnet::strong, fault::magnet_strong);
  faults.failure |= of_magnet(world.magnet, Magnet::unreadable, fault::angle_sensor);
  faults.failure |= world.driver_stopped ? fault::motor_driver : 0;
  faults.failure |= world.rotation_abnormal ? fault::motor : 0;
  return faults;
}

bool stops_motor(const Memory& registers, const World& world, const Behaviour& behaviour,
                 std::int64_t failures) {
  const std::int64_t past = behaviour.restart_bits_stop ? 0 : fault::restart_failures;
  const auto stops = [&](std::int64_t measured, const Range& range) {
    return beyond(measured, registers.value(range.upper), registers.value(range.lower),
                  behaviour.inclusive_stops);
  };
  const auto& [temperature, voltage] = warnings;
  return (failures & ~past) != 0 || stops(world.board_celsius, temperature) ||
         stops(world.supply_decivolt, voltage);
}

} // namespace blactl::sim
