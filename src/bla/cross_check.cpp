#include "blactl/bla/cross_check.hpp"

#include "bla/cross_check_rules.hpp"
#include "bla/texts.hpp"

#include <algorithm>
#include <array>

namespace blactl::bla {

namespace at = address;

namespace {

constexpr std::array speed_and_torque{at::command_speed, at::command_torque};
constexpr std::array control_switch{at::speed_torque_control};
constexpr std::array commands_and_timeout{at::command_speed, at::command_torque,
                                          at::timeout_action};
constexpr std::array temperature_limits{at::temperature_limit_high, at::temperature_limit_low};
constexpr std::array voltage_limits{at::voltage_limit_high, at::voltage_limit_low};
constexpr std::array output{at::torque_output};
constexpr std::array signs_of_soft_start{at::torque_output, at::soft_start, at::current_angle,
                                         at::command_angle};
constexpr std::array temperature{at::current_temperature};
constexpr std::array temperature_and_warnings{at::current_temperature, at::fault_warning};
constexpr std::array supply{at::current_voltage};
constexpr std::array supply_and_warnings{at::current_voltage, at::fault_warning};
constexpr std::array always_moving{
    at::command_angle, at::command_speed,  at::command_torque,       at::torque_output,
    at::reverse,       at::extended_angle, at::speed_torque_control, at::timeout_action,
    at::timeout_time,  at::origin};
constexpr std::array angle_limits{at::angle_limit_cw, at::angle_limit_ccw};
constexpr std::array present_angle{at::current_angle};
constexpr std::array present_command{at::command_angle};
constexpr std::array torque_limits{at::torque_limit_cw, at::torque_limit_ccw};
constexpr std::array torque_limits_and_switch{at::torque_limit_cw, at::torque_limit_ccw,
                                              at::speed_torque_control};
constexpr std::array limits_and_switch{at::speed_limit_cw, at::speed_limit_ccw, at::torque_limit_cw,
                                       at::torque_limit_ccw, at::speed_torque_control};
constexpr std::array limits_switch_and_angle{at::speed_limit_cw,       at::speed_limit_ccw,
                                             at::torque_limit_cw,      at::torque_limit_ccw,
                                             at::speed_torque_control, at::command_angle};
constexpr std::array pwm_mapping{at::pwm_neutral, at::pwm_range, at::pwm_output_range,
                                 at::pwm_mode};
constexpr std::array pulse_range{at::pwm_neutral, at::pwm_range};
constexpr std::array notices{at::fault_notice};
constexpr std::array pwm_and_angle{at::pwm_output_range, at::pwm_mode, at::angle_limit_cw,
                                   at::angle_limit_ccw};
constexpr std::array pwm_and_speed{at::pwm_output_range, at::pwm_mode, at::speed_limit_cw,
                                   at::speed_limit_ccw};
constexpr std::array pwm_and_control{at::pwm_mode, at::speed_torque_control};
constexpr std::array ranges_of_motion{at::pwm_output_range, at::angle_limit_cw,
                                      at::angle_limit_ccw};
constexpr std::array dead_bands{at::angle_dead_band};
constexpr std::array timeout_time{at::timeout_time};
constexpr std::array servo_ids{at::servo_id};
constexpr std::array speed_control{at::speed_p_gain, at::speed_i_gain, at::speed_dead_band,
                                   at::speed_i_limit};
constexpr std::array start_switches{at::torque_output, at::soft_start};
constexpr std::array speeds{at::command_speed, at::speed_torque_control, at::pwm_mode};
constexpr std::span<const Address> nothing_else{};

using enum CheckKind;

constexpr CrossCheck table[]{
    {"control_off", refusal, speed_and_torque, control_switch, meets_control_off,
     texts::check_control_off, "speed_torque_control=on"},
    {"no_stop", refusal, commands_and_timeout, commands_and_timeout, meets_no_stop,
     texts::check_no_stop, "timeout_action=off"},
    {"temperature_limits_reversed", refusal, temperature_limits, temperature_limits,
     meets_reversed_limits, texts::check_limits_reversed},
    {"voltage_limits_reversed", refusal, voltage_limits, voltage_limits, meets_reversed_limits,
     texts::check_limits_reversed},

    {always_asked, question, always_moving, nothing_else, [](const Proposal&) { return true; },
     texts::check_always_asked},
    {"soft_start_ends", question, output, signs_of_soft_start, meets_soft_start,
     texts::check_soft_start_ends},
    {"pulled_back", question, angle_limits, present_angle, meets_pulled_back,
     texts::check_pulled_back},
    {"let_go_on", question, angle_limits, present_command, meets_let_go_on, texts::check_let_go_on},
    {"no_torque", question, torque_limits_and_switch, torque_limits_and_switch, meets_no_torque,
     texts::check_no_torque},
    {"no_torque_later", question, torque_limits, control_switch, meets_no_torque_later,
     texts::check_no_torque_later},
    {"temperature_trips", question, temperature_limits, temperature, meets_trips,
     texts::check_temperature_trips},
    {"voltage_trips", question, voltage_limits, supply, meets_trips, texts::check_voltage_trips},
    {"temperature_released", question, temperature_limits, temperature_and_warnings,
     meets_protection_ends, texts::check_protection_released},
    {"voltage_released", question, voltage_limits, supply_and_warnings, meets_protection_ends,
     texts::check_protection_released},
    {"pwm_present", question, pwm_mapping, notices, meets_pwm_present, texts::check_pwm_present},

    {"pwm_cut_off", warning, pwm_and_angle, pwm_and_angle, meets_pwm_cut_off,
     texts::check_pwm_cut_off},
    {"pwm_needs_switch", warning, pwm_and_control, pwm_and_control, meets_pwm_without_control,
     texts::check_pwm_needs_switch},
    {"pwm_speed_limited", warning, pwm_and_speed, pwm_and_speed, meets_pwm_speed_limited,
     texts::check_pwm_speed_limited},
    {"limits_without_effect", warning, limits_switch_and_angle, limits_and_switch,
     meets_limits_without_effect, texts::check_limits_without_effect},
    {"no_motion", warning, ranges_of_motion, angle_limits, meets_no_motion, texts::check_no_motion},
    {"pwm_below_zero", warning, pulse_range, pulse_range, meets_negative_pulse,
     texts::check_pwm_below_zero},
    {"dead_band_zero", warning, dead_bands, nothing_else, meets_zero, texts::check_dead_band_zero},
    {"near_supply", warning, voltage_limits, supply, meets_near_supply, texts::check_near_supply},
    {"timeout_short", warning, timeout_time, nothing_else, meets_short_timeout,
     texts::check_timeout_short},
    {"servo_id_of_all", warning, servo_ids, nothing_else, meets_zero, texts::check_servo_id_of_all},
    {"leave_at_default", warning, speed_control, nothing_else, meets_not_default,
     texts::check_leave_at_default},
    {"hard_start", warning, start_switches, start_switches, meets_hard_start,
     texts::check_hard_start},
    {"low_speed_stall", warning, speeds, nothing_else, meets_stall, texts::check_low_speed_stall},
};

} // namespace

std::string_view name(CheckKind kind) {
  switch (kind) {
  case CheckKind::refusal: return "refusal";
  case CheckKind::question: return "question";
  case CheckKind::warning: break;
  }
  return "warning";
}

bool CrossCheck::is_about(Address address) const {
  return std::ranges::find(of, address) != of.end();
}

std::span<const CrossCheck> cross_checks() {
  return table;
}

std::vector<Address> values_needed(Address address) {
  std::vector<Address> needed;
  for (const CrossCheck& check : table) {
    for (const Address other : check.is_about(address) ? check.needs : nothing_else) {
      if (other != address && std::ranges::find(needed, other) == needed.end()) {
        needed.push_back(other);
      }
    }
  }
  return needed;
}

std::vector<const CrossCheck*> met(CheckKind kind, const Proposal& change) {
  std::vector<const CrossCheck*> all;
  for (const CrossCheck& check : table) {
    if (check.kind == kind && check.is_about(change.address) && check.fires(change)) {
      all.push_back(&check);
    }
  }
  return all;
}

bool may_move(const Proposal& change) {
  return !met(CheckKind::question, change).empty();
}

} // namespace blactl::bla
