#include "blactl/sim/servo/motor.hpp"

#include "blactl/sim/servo/world.hpp"

#include "sim/servo/names.hpp"
#include "sim/servo/soft_start.hpp"

#include <algorithm>

namespace blactl::sim {
namespace {

/// unproven: 0x32 counts thousandths of 1 rpm.
constexpr std::int64_t dead_band_per_rpm = 1000;

/// unproven: that the limits of 4.2 for BLA21 hold for other series, as far as their own limits
/// allow.
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
  const auto usual = [&](bla::Address address) {
    const bla::Parameter* parameter = existing(address);
    return std::max<std::int64_t>(parameter != nullptr ? parameter->default_raw.value_or(1) : 1, 1);
  };
  motor.usual_speed_p = usual(address::speed_p_gain);
  motor.usual_speed_i = usual(address::speed_i_gain);
  motor.usual_integral_limit = usual(address::speed_i_limit);
  motor.has_boost = existing(address::angle_boost) != nullptr;
  return motor;
}

Tuning tuning_of(const Motor& motor, const Memory& registers, bool soft_start) {
  const auto value = [&](bla::Address address) {
    const auto temporary = soft_start ? soft_start_value(address) : std::nullopt;
    return temporary.value_or(registers.value(address));
  };
  Tuning tuning;
  tuning.cascade = soft_start || registers.controls_speed();
  tuning.smooth = value(address::smoothing) != 0;
  tuning.p_gain = value(address::angle_p_gain);
  tuning.d_gain = value(address::angle_d_gain);
  tuning.dead_band = value(address::angle_dead_band) * angle_per_decideg;
  tuning.boost = motor.has_boost ? value(address::angle_boost) * effort_per_percent / 10 : 0;
  tuning.speed_cw = value(address::speed_limit_cw) * speed_per_rpm;
  tuning.speed_ccw = value(address::speed_limit_ccw) * speed_per_rpm;
  if (motor.full_current > 0) {
    tuning.effort_limit = value(address::overcurrent_limit) * full_effort / motor.full_current;
  }
  tuning.effort_cw = value(address::torque_limit_cw) * tuning.whole_effort() / 100;
  tuning.effort_ccw = value(address::torque_limit_ccw) * tuning.whole_effort() / 100;
  tuning.full_speed = motor.full_speed;
  tuning.speed_p = {value(address::speed_p_gain), motor.usual_speed_p};
  tuning.speed_i = {value(address::speed_i_gain), motor.usual_speed_i};
  tuning.speed_dead_band = value(address::speed_dead_band) * speed_per_rpm / dead_band_per_rpm;
  tuning.integral_limit = value(address::speed_i_limit) * full_effort / motor.usual_integral_limit;
  return tuning;
}

} // namespace blactl::sim
