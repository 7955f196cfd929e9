#include "blactl/sim/servo/world.hpp"

#include "blactl/sim/servo/servo_setup.hpp"

#include "sim/servo/names.hpp"

namespace blactl::sim {
namespace {

/// "ram" gives the bits of 0x19; those of the PWM input become a pulse.
void set_notices(World& world, std::int64_t bits, const ServoSetup& setup) {
  constexpr std::int64_t too_short_us = 1;
  constexpr std::int64_t too_long_us = 30'000; // longer than any 0x34 + 0x35
  world.notices = bits & ~fault::pwm_input;
  if (!setup.profile->pwm) {
    return;
  }
  if ((bits & fault::pwm_too_short) != 0) {
    world.pulse_us = too_short_us;
  } else if ((bits & fault::pwm_too_long) != 0) {
    world.pulse_us = too_long_us;
  }
}

} // namespace

std::int64_t nominal_decivolt(const ServoSetup& setup) {
  const std::string_view voltage_class = setup.profile->voltage_class;
  if (voltage_class == "06U") {
    return 74;
  }
  return voltage_class == "28U" ? 280 : 120;
}

World world_of(const ServoSetup& setup) {
  World world;
  world.supply_decivolt = nominal_decivolt(setup);
  for (const auto& [where, value] : setup.ram) {
    if (where == address::current_temperature) {
      world.board_celsius = value;
    } else if (where == address::current_voltage) {
      world.supply_decivolt = value;
    } else if (where == address::fault_notice) {
      set_notices(world, value, setup);
    } else if (where == address::fault_warning) {
      world.warnings = value;
    } else if (where == address::fault_failure) {
      world.failures = value;
    }
  }
  return world;
}

} // namespace blactl::sim
