#include "blactl/bla/effect.hpp"

#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/parameter.hpp"

#include <algorithm>
#include <initializer_list>

namespace blactl::bla {

namespace at = address;

namespace {

bool is_one_of(Address address, std::initializer_list<Address> set) {
  return std::ranges::find(set, address) != set.end();
}

/// Every change of these is asked.
bool always_moves(Address address) {
  return is_one_of(address,
                   {at::command_angle, at::command_speed, at::command_torque, at::torque_output,
                    at::reverse, at::extended_angle, at::speed_torque_control, at::timeout_action,
                    at::timeout_time, at::origin});
}

bool is_angle_limit(Address address) {
  return is_one_of(address, {at::angle_limit_cw, at::angle_limit_ccw});
}

bool is_torque_limit(Address address) {
  return is_one_of(address, {at::torque_limit_cw, at::torque_limit_ccw});
}

bool is_pwm_mapping(Address address) {
  return is_one_of(address, {at::pwm_neutral, at::pwm_range, at::pwm_output_range, at::pwm_mode});
}

/// The measured value that a protection limit is compared with, and on which side of it.
struct Protection {
  Address limit, measured;
  bool is_upper;
  std::int64_t warning; ///< bit of 0x1A while it holds the motor off
};

constexpr std::initializer_list<Protection> protections{
    {at::temperature_limit_high, at::current_temperature, true, fault::temperature_high},
    {at::temperature_limit_low, at::current_temperature, false, fault::temperature_low},
    {at::voltage_limit_high, at::current_voltage, true, fault::voltage_high},
    {at::voltage_limit_low, at::current_voltage, false, fault::voltage_low},
};

const Protection* protection(Address address) {
  const auto* it = std::ranges::find(protections, address, &Protection::limit);
  return it != protections.end() ? it : nullptr;
}

/// Limits that the present value trips at once (inclusive, 4.12).
bool trips(const Protection& protection, std::int64_t limit, const Values& now) {
  const auto measured = find(now, protection.measured);
  return !measured || (protection.is_upper ? *measured >= limit : *measured <= limit);
}

/// A protection that holds the motor off now, and would not with this limit: torque comes back.
bool ends(const Protection& protection, std::int64_t limit, const Values& now) {
  const auto warnings = find(now, at::fault_warning);
  const bool is_active = !warnings || (*warnings & protection.warning) != 0;
  return is_active && !trips(protection, limit, now);
}

/// A wider limit lets the shaft run on to a command that is still there.
bool releases(Address address, std::int64_t limit, const Values& now) {
  const auto command = find(now, at::command_angle);
  const auto held = find(now, address);
  if (!command || !held) {
    return true;
  }
  const bool is_cw = address == at::angle_limit_cw;
  const bool is_wider = is_cw ? limit > *held : limit < *held;
  const bool is_beyond = is_cw ? *command > *held : *command < *held;
  return is_wider && is_beyond && *command != not_active;
}

/// An angle limit inside of the present angle pulls the shaft back.
bool pulls_back(Address address, std::int64_t limit, const Values& now) {
  const auto angle = find(now, at::current_angle);
  return !angle || (address == at::angle_limit_cw ? limit < *angle : limit > *angle);
}

bool has_pwm_input(const Values& now) {
  const auto notices = find(now, at::fault_notice);
  return !notices || (*notices & fault::pwm_missing) == 0;
}

} // namespace

std::vector<Address> values_needed(Address address) {
  if (is_angle_limit(address)) {
    return {at::current_angle, at::command_angle, address};
  }
  if (const Protection* watched = protection(address)) {
    return {watched->measured, at::fault_warning};
  }
  if (const auto needed = needs_on(address)) {
    return {*needed};
  }
  return is_pwm_mapping(address) ? std::vector{at::fault_notice} : std::vector<Address>{};
}

bool may_move(Address address, std::int64_t requested, const Values& now) {
  if (always_moves(address)) {
    return true;
  }
  if (is_torque_limit(address)) {
    return requested == 0;
  }
  if (is_pwm_mapping(address)) {
    return has_pwm_input(now);
  }
  if (is_angle_limit(address)) {
    return pulls_back(address, requested, now) || releases(address, requested, now);
  }
  const Protection* watched = protection(address);
  return watched != nullptr && (trips(*watched, requested, now) || ends(*watched, requested, now));
}

std::optional<Address> needs_on(Address address) {
  return is_one_of(address, {at::command_speed, at::command_torque})
             ? std::optional(at::speed_torque_control)
             : std::nullopt;
}

bool should_stay_at_default(Address address) {
  return is_one_of(address,
                   {at::speed_p_gain, at::speed_i_gain, at::speed_dead_band, at::speed_i_limit});
}

RestartMotion restart_motion(const Values& configuration) {
  const auto may_be = [&](Address address, std::int64_t raw) {
    return find(configuration, address).value_or(raw) == raw;
  };
  constexpr std::int64_t torque_on = 0; // 0x20 counts upside down (4.13)
  constexpr std::int64_t soft_start_on = 1;
  if (!may_be(at::torque_output, torque_on)) {
    return RestartMotion::none;
  }
  return may_be(at::soft_start, soft_start_on) ? RestartMotion::soft : RestartMotion::hard;
}

} // namespace blactl::bla
