#include "blactl/bla/cross_check.hpp"

#include "blactl/bla/defect.hpp"
#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/parameter.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

namespace blactl::bla {

namespace at = address;

namespace {

constexpr std::int64_t off = 0, on = 1;                // most switches
constexpr std::int64_t torque_on = 0;                  // 0x20 counts upside down (4.13)
constexpr std::int64_t timeout_hold = 0;               // 0x26
constexpr std::int64_t angle_mode = 0, speed_mode = 1; // 0x37
constexpr std::int64_t tenths = 10;

bool holds(const Values& values, Address address, std::int64_t raw) {
  return find(values, address) == raw;
}

/// Both are known, and `compare` holds.
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

/// A command of speed or torque that runs until something ends it.
bool runs(std::optional<std::int64_t> command) {
  return command && *command != 0 && *command != not_active;
}

// Refusals

bool meets_control_off(const Proposal& change) {
  return holds(change.after, at::speed_torque_control, off);
}

bool meets_no_stop(const Proposal& change) {
  return holds(change.after, at::timeout_action, timeout_hold) &&
         (runs(change.address == at::timeout_action ? std::nullopt
                                                    : std::optional(change.requested)) ||
          (change.address == at::timeout_action && (runs(find(change.after, at::command_speed)) ||
                                                    runs(find(change.after, at::command_torque)))));
}

bool meets_reversed_limits(const Proposal& change) {
  const bool is_voltage =
      change.address == at::voltage_limit_high || change.address == at::voltage_limit_low;
  return both(change.after, is_voltage ? at::voltage_limit_high : at::temperature_limit_high,
              is_voltage ? at::voltage_limit_low : at::temperature_limit_low, std::less_equal());
}

// Questions: what is not known may be the worst

/// An angle limit inside of the present angle.
bool meets_pulled_back(const Proposal& change) {
  const auto angle = find(change.before, at::current_angle);
  return !angle || (is_cw(change.address) ? change.requested < *angle : change.requested > *angle);
}

/// A wider limit, with a command beyond the old one that is still there.
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

/// The measured value that a protection limit is compared with, and on which side of it.
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

/// Limits are inclusive (4.12).
bool meets_trips(const Proposal& change) {
  const Protection& watched = protection(change.address);
  const auto measured = find(change.before, watched.measured);
  return !measured ||
         (watched.is_upper ? *measured >= change.requested : *measured <= change.requested);
}

/// A protection that holds the motor off now, and would not with this limit.
bool meets_protection_ends(const Proposal& change) {
  const auto warnings = find(change.before, at::fault_warning);
  const bool is_active = !warnings || (*warnings & protection(change.address).warning) != 0;
  return is_active && !meets_trips(change);
}

bool meets_pwm_present(const Proposal& change) {
  const auto notices = find(change.before, at::fault_notice);
  return !notices || (*notices & fault::pwm_missing) == 0;
}

// Warnings

bool meets_pwm_cut_off(const Proposal& change) {
  const auto beyond = [](std::int64_t output, std::int64_t limit) { return output > limit; };
  const auto below = [](std::int64_t output, std::int64_t limit) { return -output < limit; };
  return has_pwm_input(change.servo) && holds(change.after, at::pwm_mode, angle_mode) &&
         (both(change.after, at::pwm_output_range, at::angle_limit_cw, beyond) ||
          both(change.after, at::pwm_output_range, at::angle_limit_ccw, below));
}

bool meets_pwm_speed_limited(const Proposal& change) {
  const auto beyond = [](std::int64_t output, std::int64_t limit) { return output > limit; };
  const auto below = [](std::int64_t output, std::int64_t limit) { return -output < limit; };
  return has_pwm_input(change.servo) && holds(change.after, at::pwm_mode, speed_mode) &&
         (both(change.after, at::pwm_output_range, at::speed_limit_cw, beyond) ||
          both(change.after, at::pwm_output_range, at::speed_limit_ccw, below));
}

bool meets_pwm_without_control(const Proposal& change) {
  return has_pwm_input(change.servo) && holds(change.after, at::pwm_mode, speed_mode) &&
         holds(change.after, at::speed_torque_control, off);
}

bool meets_no_motion(const Proposal& change) {
  if (change.address == at::pwm_range || change.address == at::pwm_output_range) {
    return change.requested == 0;
  }
  return both(change.after, at::angle_limit_cw, at::angle_limit_ccw, std::equal_to());
}

/// Such a pulse cannot be.
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

// Which registers

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
constexpr std::array ranges_of_motion{at::pwm_range, at::pwm_output_range, at::angle_limit_cw,
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
      "speed_torque_control (0x25) が OFF の間、サーボは速度・トルク指令を受け付けません"},
     "speed_torque_control=on"},
    {"no_stop",
     CheckKind::refusal,
     commands_and_timeout,
     commands_and_timeout,
     meets_no_stop,
     {"with timeout_action=hold (0x26) nothing stops a speed or torque command when the sender "
      "falls silent",
      "timeout_action=hold (0x26) では、送信元が停止しても速度・トルク指令が継続します"},
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
     {"without torque the servo lets go of the load", "トルクが 0 になり、負荷を保持できません"}},
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
      "speed_torque_control (0x25) が OFF の間、速度モードの PWM では動作しません"}},
    {"pwm_speed_limited",
     CheckKind::warning,
     pwm_and_speed,
     pwm_and_speed,
     meets_pwm_speed_limited,
     {"the PWM output range is beyond the speed limits: the speed stays at the limit",
      "PWM の出力範囲が動作速度制限を超えています。速度は制限値にとどまります"}},
    {"no_motion",
     CheckKind::warning,
     ranges_of_motion,
     angle_limits,
     meets_no_motion,
     {"this range leaves no motion", "この範囲では動作しません"}},
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
      "不感帯が 0 の場合、ハンチングや発熱の可能性があります"}},
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
     {"this firmware may stall at low speed; 1.400 mends it",
      "このファームウェアは低速動作時に停止することがあります (1.400 で修正)"}},
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
