#include "blactl/bla/cross_check.hpp"

#include "bla/cross_check_rules.hpp"

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
constexpr std::array speed_control{at::speed_p_gain, at::speed_i_gain, at::speed_dead_band,
                                   at::speed_i_limit};
constexpr std::array start_switches{at::torque_output, at::soft_start};
constexpr std::array speeds{at::command_speed, at::speed_torque_control, at::pwm_mode};
constexpr std::span<const Address> nothing_else{};

constexpr CrossCheck table[]{
    {"control_off",
     CheckKind::refusal,
     speed_and_torque,
     control_switch,
     meets_control_off,
     {"the servo takes no speed or torque while speed_torque_control (0x25) is off",
      "speed_torque_control (0x25) が OFF の間、指令速度/指令トルクは無視されます"},
     "speed_torque_control=on"},
    {"no_stop",
     CheckKind::refusal,
     commands_and_timeout,
     commands_and_timeout,
     meets_no_stop,
     {"with timeout_action=hold (0x26) nothing stops a speed or torque command when the sender "
      "falls silent",
      "timeout_action=hold (0x26) では、送信元が停止しても指令速度/指令トルクの動作が継続します"},
     "timeout_action=off"},
    {"temperature_limits_reversed",
     CheckKind::refusal,
     temperature_limits,
     temperature_limits,
     meets_reversed_limits,
     {"the upper limit must be above the lower one, or the motor is always off",
      "上限は下限より大きい値でなければなりません (モータが常に停止します)"}},
    {"voltage_limits_reversed",
     CheckKind::refusal,
     voltage_limits,
     voltage_limits,
     meets_reversed_limits,
     {"the upper limit must be above the lower one, or the motor is always off",
      "上限は下限より大きい値でなければなりません (モータが常に停止します)"}},

    {always_asked,
     CheckKind::question,
     always_moving,
     nothing_else,
     [](const Proposal&) { return true; },
     {"any change can move the shaft or let go of the load",
      "変更により出力軸の動作または脱力の可能性があります"}},
    {"pulled_back",
     CheckKind::question,
     angle_limits,
     present_angle,
     meets_pulled_back,
     {"the shaft is beyond the limit: it runs back to it",
      "現在角度が制限を超えているため、制限角度まで動作します"}},
    {"let_go_on",
     CheckKind::question,
     angle_limits,
     present_command,
     meets_let_go_on,
     {"a command beyond the old limit is still there: the shaft runs on to it",
      "変更前の制限を超える指令が残っているため、その角度まで動作します"}},
    {"no_torque",
     CheckKind::question,
     torque_limits,
     nothing_else,
     meets_zero,
     {"with a limit of 0 % the servo lets go of the load",
      "制限値が 0 % の場合、負荷を保持できません"}},
    {"temperature_trips",
     CheckKind::question,
     temperature_limits,
     temperature,
     meets_trips,
     {"the present temperature trips the limit at once: the motor is switched off",
      "現在の温度が制限に達しているため、直ちにモータが停止します"}},
    {"voltage_trips",
     CheckKind::question,
     voltage_limits,
     supply,
     meets_trips,
     {"the present voltage trips the limit at once: the motor is switched off",
      "現在の電圧が制限に達しているため、直ちにモータが停止します"}},
    {"temperature_released",
     CheckKind::question,
     temperature_limits,
     temperature_and_warnings,
     meets_protection_ends,
     {"the protection that holds the motor off ends: torque comes back",
      "モータを停止させている保護が解除され、トルクが復帰します"}},
    {"voltage_released",
     CheckKind::question,
     voltage_limits,
     supply_and_warnings,
     meets_protection_ends,
     {"the protection that holds the motor off ends: torque comes back",
      "モータを停止させている保護が解除され、トルクが復帰します"}},
    {"pwm_present",
     CheckKind::question,
     pwm_mapping,
     notices,
     meets_pwm_present,
     {"a PWM signal is present: the shaft follows the new mapping",
      "PWM 信号が入力されているため、新しい設定に従って動作します"}},

    {"pwm_cut_off",
     CheckKind::warning,
     pwm_and_angle,
     pwm_and_angle,
     meets_pwm_cut_off,
     {"the PWM output range reaches beyond the angle limits: the shaft stops at the limit",
      "PWM の出力範囲が動作角度制限を超えています。出力軸は制限角度で停止します"}},
    {"pwm_needs_switch",
     CheckKind::warning,
     pwm_and_control,
     pwm_and_control,
     meets_pwm_without_control,
     {"PWM in speed mode moves nothing while speed_torque_control (0x25) is off",
      "speed_torque_control (0x25) が OFF の間、PWM の速度指令では動作しません"}},
    {"pwm_speed_limited",
     CheckKind::warning,
     pwm_and_speed,
     pwm_and_speed,
     meets_pwm_speed_limited,
     {"the PWM output range exceeds the speed limits: the speed stays at the limit",
      "PWM の出力範囲が動作速度制限を超えています。速度は制限値にとどまります"}},
    {"no_motion",
     CheckKind::warning,
     ranges_of_motion,
     angle_limits,
     meets_no_motion,
     {"the range of motion is 0: nothing moves", "動作範囲が 0 のため動作しません"}},
    {"pwm_below_zero",
     CheckKind::warning,
     pulse_range,
     pulse_range,
     meets_negative_pulse,
     {"the range reaches below 0 us: that end of the output cannot be reached",
      "入力範囲の下限が 0 us 未満になります。その側の端までは動作しません"}},
    {"dead_band_zero",
     CheckKind::warning,
     dead_bands,
     nothing_else,
     meets_zero,
     {"without a dead band the servo may hunt and heat up",
      "デッドバンドが 0 の場合、ハンチングや発熱の可能性があります"}},
    {"near_supply",
     CheckKind::warning,
     voltage_limits,
     supply,
     meets_near_supply,
     {"the present supply is less than 0.5 V away: a dip or a peak under load switches the motor "
      "off",
      "現在電圧との差が 0.5 V 未満です。負荷変動でモータが停止する可能性があります"}},
    {"timeout_short",
     CheckKind::warning,
     timeout_time,
     nothing_else,
     meets_short_timeout,
     {"shorter than 100 ms: a few commands that come late are taken for a loss of communication",
      "100 ms 未満では、指令の遅れを通信途絶と判定する可能性があります"}},
    {"leave_at_default",
     CheckKind::warning,
     speed_control,
     nothing_else,
     meets_not_default,
     {"the manufacturer advises to leave it at its default",
      "メーカーは初期値のままとすることを推奨しています"}},
    {"hard_start",
     CheckKind::warning,
     start_switches,
     start_switches,
     meets_hard_start,
     {"when the servo starts, torque comes on at once where the shaft is, and the first command is "
      "followed at full speed",
      "起動時に現在位置で直ちにトルクが ON になり、最初の指令に全速で動作します"}},
    {"low_speed_stall",
     CheckKind::warning,
     speeds,
     nothing_else,
     meets_stall,
     {"firmware before 1.400 may stall at low speed",
      "1.400 より前のファームウェアは低速動作時にストールすることがあります"}},
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
