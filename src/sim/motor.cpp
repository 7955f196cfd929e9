#include "blactl/sim/motor.hpp"

#include "blactl/sim/world.hpp"

#include "sim/addresses.hpp"

#include <algorithm>

namespace blactl::sim {
namespace {

/// unproven: that what 4.2 says of BLA21 holds for other series, as far as their limits allow.
std::int64_t practical_rpm(const bla::Profile& profile) {
  constexpr std::int64_t bla21_rpm = 150;
  const bla::Parameter* limit = profile.find(address::speed_limit_cw);
  const std::int64_t rpm = limit != nullptr ? limit->default_raw.value_or(0) : 0;
  return std::clamp<std::int64_t>(rpm, 1, bla21_rpm);
}

} // namespace

Motor motor_of(const ServoSetup& setup) {
  const auto existing = [&](bla::Address address) {
    const bla::Parameter* parameter = setup.profile->find(address);
    return parameter != nullptr && parameter->exists_in(setup.firmware_version) ? parameter
                                                                                : nullptr;
  };
  Motor motor;
  motor.nominal_decivolt = nominal_decivolt(setup);
  motor.full_speed = practical_rpm(*setup.profile) * speed_per_rpm;
  if (const bla::Parameter* current = existing(address::overcurrent_limit)) {
    motor.full_current = current->default_raw.value_or(0);
  }
  motor.has_boost = existing(address::angle_boost) != nullptr;
  return motor;
}

Tuning tuning_of(const Motor& motor, const Registers& registers, bool soft_start) {
  const auto value = [&](bla::Address address) { return registers.value(address); };
  Tuning tuning;
  tuning.cascade = soft_start || value(address::speed_torque_control) != 0;
  tuning.smooth = value(address::smoothing) != 0;
  tuning.p_gain = value(address::angle_p_gain);
  tuning.d_gain = value(address::angle_d_gain);
  tuning.dead_band = value(address::angle_dead_band) * angle_per_decideg;
  tuning.boost = motor.has_boost ? value(address::angle_boost) * effort_per_percent / 10 : 0;
  tuning.speed_cw = value(address::speed_limit_cw) * speed_per_rpm;
  tuning.speed_ccw = value(address::speed_limit_ccw) * speed_per_rpm;
  tuning.effort_cw = value(address::torque_limit_cw) * effort_per_percent;
  tuning.effort_ccw = value(address::torque_limit_ccw) * effort_per_percent;
  if (motor.full_current > 0) {
    tuning.effort_limit =
        std::min(value(address::overcurrent_limit) * full_effort / motor.full_current, full_effort);
  }
  tuning.full_speed = motor.full_speed;
  if (soft_start) {
    tuning.speed_cw = 30 * speed_per_rpm;
    tuning.effort_cw = 30 * effort_per_percent;
    tuning.speed_ccw = -tuning.speed_cw;
    tuning.effort_ccw = -tuning.effort_cw;
  }
  return tuning;
}

} // namespace blactl::sim
