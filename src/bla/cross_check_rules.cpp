#include "bla/cross_check_rules.hpp"

#include "blactl/bla/defect.hpp"
#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/parameter.hpp"
#include "blactl/bla/value.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

namespace blactl::bla {

namespace at = address;

namespace {

constexpr std::int64_t off = 0, on = 1;  // most switches
constexpr std::int64_t torque_on = 0;    // 0x20 counts upside down (4.13)
constexpr std::int64_t timeout_hold = 0; // 0x26
constexpr std::int64_t tenths = 10;

bool holds(const Values& values, Address address, std::int64_t raw) {
  return find(values, address) == raw;
}

/// Whether both values are known and `compare` holds.
template <class Compare>
bool both(const Values& values, Address first, Address second, Compare compare) {
  const auto left = find(values, first);
  const auto right = find(values, second);
  return left && right && compare(*left, *right);
}

bool has_pwm_input(const Identity& servo) {
  return servo.profile() != nullptr && servo.profile()->pwm;
}

bool is_cw(Address address) {
  return address == at::angle_limit_cw;
}

/// Whether a command of speed or torque runs until something ends it.
bool runs(std::optional<std::int64_t> command) {
  return command && *command != 0 && *command != not_active;
}

/// Whether in this mode the PWM output range exceeds one of the limits.
bool maps_beyond(const Proposal& change, std::int64_t mode, Address limit_cw, Address limit_ccw) {
  const auto is_above = [](std::int64_t output, std::int64_t limit) { return output > limit; };
  const auto is_below = [](std::int64_t output, std::int64_t limit) { return -output < limit; };
  return has_pwm_input(change.servo) && holds(change.after, at::pwm_mode, mode) &&
         (both(change.after, at::pwm_output_range, limit_cw, is_above) ||
          both(change.after, at::pwm_output_range, limit_ccw, is_below));
}

constexpr std::array switched_limits{at::speed_limit_cw, at::speed_limit_ccw, at::torque_limit_cw,
                                     at::torque_limit_ccw};

/// Without speed/torque control 0x01, 0x02 and 0x3A-0x3D are ignored (4.18, 4.32, 4.33).
bool has_control_off(const Proposal& change) {
  return holds(change.after, at::speed_torque_control, off);
}

/// The measured value that a protection limit is compared with, and the direction.
struct Protection {
  Address limit, measured;
  bool is_upper;
  std::int64_t warning; ///< bit of 0x1A while it holds the motor off
};

constexpr std::array protections{
    Protection{at::temperature_limit_high, at::current_temperature, true, fault::temperature_high},
    Protection{at::temperature_limit_low, at::current_temperature, false, fault::temperature_low},
    Protection{at::voltage_limit_high, at::current_voltage, true, fault::voltage_high},
    Protection{at::voltage_limit_low, at::current_voltage, false, fault::voltage_low},
};

const Protection& protection(Address limit) {
  return *std::ranges::find(protections, limit, &Protection::limit);
}

} // namespace

// Refusals

bool meets_control_off(const Proposal& change) {
  return has_control_off(change);
}

bool meets_no_stop(const Proposal& change) {
  if (!holds(change.after, at::timeout_action, timeout_hold)) {
    return false;
  }
  if (change.address != at::timeout_action) {
    return runs(change.requested);
  }
  return runs(find(change.after, at::command_speed)) ||
         runs(find(change.after, at::command_torque));
}

bool meets_reversed_limits(const Proposal& change) {
  const bool is_voltage =
      change.address == at::voltage_limit_high || change.address == at::voltage_limit_low;
  return both(change.after, is_voltage ? at::voltage_limit_high : at::temperature_limit_high,
              is_voltage ? at::voltage_limit_low : at::temperature_limit_low, std::less_equal());
}

// Questions: assume the worst of unknown values

/// Its output is on, and it may be on its way from the start to 0 deg, which it has not reached
/// (4.14). unproven: that a write of 0x20 then lets it run on at full speed.
bool meets_soft_start(const Proposal& change) {
  constexpr std::int64_t arrived_decideg = 10;
  const auto may_be = [&](Address address, std::int64_t raw) {
    return find(change.before, address).value_or(raw) == raw;
  };
  const auto angle = find(change.before, at::current_angle);
  const bool is_there = angle && *angle >= -arrived_decideg && *angle <= arrived_decideg;
  return may_be(at::torque_output, torque_on) && may_be(at::soft_start, on) &&
         may_be(at::command_angle, 0) && !is_there;
}

/// The new angle limit is inside the present angle.
bool meets_pulled_back(const Proposal& change) {
  const auto angle = find(change.before, at::current_angle);
  return !angle || (is_cw(change.address) ? change.requested < *angle : change.requested > *angle);
}

/// The limit widens while a command beyond the old one is still present.
bool meets_let_go_on(const Proposal& change) {
  const auto command = find(change.before, at::command_angle);
  const auto held = find(change.before, change.address);
  if (!command || !held) {
    return true;
  }
  const bool cw = is_cw(change.address);
  const bool is_wider = cw ? change.requested > *held : change.requested < *held;
  const bool is_beyond = cw ? *command > *held : *command < *held;
  return is_wider && is_beyond && *command != not_active;
}

/// A torque limit is 0 and in effect: it is set to 0, or the switch makes it count.
bool meets_no_torque(const Proposal& change) {
  if (change.address != at::speed_torque_control) {
    return change.requested == 0 && !has_control_off(change);
  }
  return change.requested == on && (find(change.after, at::torque_limit_cw).value_or(0) == 0 ||
                                    find(change.after, at::torque_limit_ccw).value_or(0) == 0);
}

bool meets_no_torque_later(const Proposal& change) {
  return change.requested == 0 && has_control_off(change);
}

/// Limits are inclusive (4.12).
bool meets_trips(const Proposal& change) {
  const Protection& watched = protection(change.address);
  const auto measured = find(change.before, watched.measured);
  return !measured ||
         (watched.is_upper ? *measured >= change.requested : *measured <= change.requested);
}

/// A protection keeps the motor off now and would not with this limit, or may not: what is measured
/// is at it (4.7: beyond it; 4.12: at it).
bool meets_protection_ends(const Proposal& change) {
  const Protection& watched = protection(change.address);
  const auto warnings = find(change.before, at::fault_warning);
  const bool is_active = !warnings || (*warnings & watched.warning) != 0;
  const auto measured = find(change.before, watched.measured);
  return is_active && measured &&
         (watched.is_upper ? *measured <= change.requested : *measured >= change.requested);
}

bool meets_pwm_present(const Proposal& change) {
  const auto notices = find(change.before, at::fault_notice);
  return !notices || (*notices & fault::pwm_missing) == 0;
}

// Warnings

/// A limit is not as from the factory, so somebody relies on it.
bool meets_limits_without_effect(const Proposal& change) {
  return has_control_off(change) && std::ranges::any_of(switched_limits, [&](Address address) {
           const Parameter* limit = change.servo.parameter(address);
           const auto held = find(change.after, address);
           return limit != nullptr && held && held != limit->default_raw;
         });
}

bool meets_pwm_cut_off(const Proposal& change) {
  return maps_beyond(change, pwm_angle_mode, at::angle_limit_cw, at::angle_limit_ccw);
}

bool meets_pwm_speed_limited(const Proposal& change) {
  return maps_beyond(change, pwm_speed_mode, at::speed_limit_cw, at::speed_limit_ccw);
}

bool meets_pwm_without_control(const Proposal& change) {
  return has_pwm_input(change.servo) && holds(change.after, at::pwm_mode, pwm_speed_mode) &&
         has_control_off(change);
}

bool meets_no_motion(const Proposal& change) {
  if (change.address == at::pwm_output_range) {
    return change.requested == 0;
  }
  return both(change.after, at::angle_limit_cw, at::angle_limit_ccw, std::equal_to());
}

/// The mapping would need negative pulses.
bool meets_negative_pulse(const Proposal& change) {
  return has_pwm_input(change.servo) &&
         both(change.after, at::pwm_range, at::pwm_neutral, std::greater());
}

bool meets_zero(const Proposal& change) {
  return change.requested == 0;
}

bool meets_near_supply(const Proposal& change) {
  constexpr std::int64_t margin = tenths / 2;
  const auto supply = find(change.before, at::current_voltage);
  const std::int64_t distance = !supply ? margin
                                : change.address == at::voltage_limit_high
                                    ? change.requested - *supply
                                    : *supply - change.requested;
  return distance > 0 && distance < margin;
}

bool meets_short_timeout(const Proposal& change) {
  constexpr std::int64_t some_commands_ms = 100;
  return change.requested < some_commands_ms;
}

bool meets_not_default(const Proposal& change) {
  const Parameter* parameter = change.servo.parameter(change.address);
  return parameter != nullptr && parameter->default_raw != change.requested;
}

bool meets_hard_start(const Proposal& change) {
  return holds(change.after, at::soft_start, off) &&
         holds(change.after, at::torque_output, torque_on);
}

bool meets_stall(const Proposal& change) {
  const bool is_speed =
      change.address == at::command_speed ? runs(change.requested) : change.requested == on;
  return is_speed && may_stall(change.servo);
}

} // namespace blactl::bla
