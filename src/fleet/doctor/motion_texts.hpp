#pragma once
// Messages of the diagnosis of a servo that does not move.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text motion_not_commanded{"node {} is commanded by nobody, as far as heard{}{}",
                                           "ノード {} への動作指令を受信していません{}{}"};
inline constexpr Text motion_timeout{"; after {} without a command (timeout_time): {}",
                                     "。指令が {} 途絶えた後 (timeout_time): {}"};
inline constexpr Text motion_timeout_hold{"it holds (timeout_action)", "保持 (timeout_action)"};
inline constexpr Text motion_timeout_off{"its output is off (timeout_action)",
                                         "出力 OFF (timeout_action)"};
inline constexpr Text motion_timeout_brake{"it brakes (timeout_action)",
                                           "ブレーキ (timeout_action)"};
inline constexpr Text motion_soft_start{
    "; by itself it only runs slowly to 0 deg after a start (soft_start)",
    "。自ら動作するのは起動直後の 0° へのソフトスタートのみです (soft_start)"};
inline constexpr Text motion_not_commanded_fix{
    "let a controller command servo ID {}; or see whether it moves: blactl command -n {} {}",
    "制御側からサーボ ID {} に指令して下さい。動作確認: blactl command -n {} {}"};
inline constexpr Text motion_try_fix{"see whether it moves: blactl command -n {} {}",
                                     "動作確認: blactl command -n {} {}"};
inline constexpr Text motion_rarely_commanded{
    "node {} commands node {} once in {} ms; in between, after {} without a command "
    "(timeout_time): {}",
    "ノード {} からノード {} への指令の間隔は {} ms です。指令が {} 途絶えると (timeout_time): {}"};
inline constexpr Text motion_rarely_commanded_fix{"let it command more often; or {}",
                                                  "指令の間隔を短くするか、{}"};
inline constexpr Text motion_commanded_other{
    "node {} commands servo ID {}; node {} has servo ID {}, which nobody commands",
    "ノード {} はサーボ ID {} に指令していますが、ノード {} のサーボ ID は {} です"};
inline constexpr Text motion_commanded_other_fix{"let it command servo ID {}",
                                                 "指令先をサーボ ID {} にして下さい"};
inline constexpr Text motion_take_servo_id_fix{
    "let it command servo ID {}; or stop it, then: blactl set -n {} servo_id={} --save",
    "指令先をサーボ ID {} にするか、指令を停止後に ID を変更: blactl set -n {} servo_id={} --save"};

inline constexpr Text motion_can_before_pwm{
    "node {} commands node {} over CAN, which goes before its PWM input: the pulses are ignored "
    "until {} without a command (timeout_time)",
    "ノード {} からの CAN 指令が優先されるため、ノード {} の PWM 信号は無視されます "
    "(CAN 指令が {} 途絶えると有効: timeout_time)"};
inline constexpr Text motion_can_before_pwm_fix{"if the pulses are to move it: stop node {}",
                                                "PWM で動作させる場合はノード {} の指令を停止"};
inline constexpr Text motion_pulse_short{
    "node {}: its PWM pulses are at the lower end of the range or below it, where they count as no "
    "input",
    "ノード {} の PWM パルス幅が入力範囲の下限以下です。範囲外の信号は入力なしと見なされます"};
inline constexpr Text motion_pulse_long{
    "node {}: its PWM pulses are at the upper end of the range or above it, where they count as no "
    "input",
    "ノード {} の PWM パルス幅が入力範囲の上限以上です。範囲外の信号は入力なしと見なされます"};
inline constexpr Text motion_pulse_fix{"compare the range with the pulses: blactl pwm-config -n {}",
                                       "入力範囲とパルス幅を照合: blactl pwm-config -n {}"};
inline constexpr Text motion_pulse_means_zero{
    "node {}: every PWM pulse asks for 0: pwm_output_range (0x36) is 0",
    "ノード {} の pwm_output_range (0x36) が 0 のため、PWM 信号は常に 0 の指令になります"};

inline constexpr Text motion_mode_off{
    "node {} commands node {} by {} ({}), which is ignored while speed_torque_control (0x25) is "
    "off",
    "ノード {} はノード {} に {} ({}) で指令していますが、speed_torque_control (0x25) が OFF の"
    "間は無視されます"};
inline constexpr Text motion_mode_fix{"let it command angles; or {}", "角度で指令するか、{}"};
inline constexpr Text motion_mode_unproven{
    "node {} commands node {} by {} ({}); before firmware 1.100 there is no speed_torque_control: "
    "only a real servo shows whether it obeys",
    "ノード {} はノード {} に {} ({}) で指令していますが、1.100 より前のファームウェアには "
    "speed_torque_control がなく、動作するかは実機でのみ確認できます"};
inline constexpr Text motion_mode_unproven_fix{"let it command angles", "角度で指令して下さい"};
inline constexpr Text motion_type_unknown{
    "node {} commands node {} by type {} of ArrayCommand, which BLA servos do not take",
    "ノード {} はノード {} に ArrayCommand の型 {} で指令していますが、BLA "
    "サーボは対応していません"};
inline constexpr Text motion_type_unknown_fix{
    "let it send UNITLESS (0), POSITION (1), FORCE (2) or SPEED (3)",
    "UNITLESS (0)、POSITION (1)、FORCE (2)、SPEED (3) のいずれかで送信して下さい"};
inline constexpr Text motion_pwm_mode_off{
    "node {}: its PWM pulses command a speed (pwm_mode, 0x37), which is ignored while "
    "speed_torque_control (0x25) is off",
    "ノード {} の PWM 信号は速度指令 (pwm_mode, 0x37) ですが、speed_torque_control (0x25) が OFF "
    "の間は無視されます"};

inline constexpr Text motion_torque_off{
    "node {}: its motor gets no output, whatever is commanded: torque_output (0x20) is {}",
    "ノード {} の torque_output (0x20) が {} のため、指令に関わらずモータに出力されません"};
inline constexpr Text motion_held_off{"node {}: {} ({} bit {}) holds the motor output off: {}{}",
                                      "ノード {}: {} ({} bit {}) によりモータ出力 OFF です: {}{}"};
inline constexpr Text motion_maybe_held_off{
    "node {}: {} ({} bit {}) may hold the motor output off: {}{}; at the limit itself only a real "
    "servo shows it",
    "ノード {}: {} ({} bit {}) によりモータ出力が OFF の可能性があります: {}{}。制限値ちょうどでの"
    "動作は実機でのみ確認できます"};
inline constexpr Text motion_held_off_fix{"{} (blactl faults -n {})", "{} (blactl faults -n {})"};

inline constexpr Text motion_torque_at_limit{
    "node {}: it is commanded, pushes with the most torque that it may, and stands still{}",
    "ノード {}: 動作指令を受け、制限値のトルクを出力していますが、軸が動いていません{}"};
inline constexpr Text motion_torque_at_limit_fix{
    "look for what blocks the shaft, or reduce the load (blactl monitor -n {})",
    "軸を妨げるものがないか確認し、負荷を減らして下さい (blactl monitor -n {})"};
inline constexpr Text motion_no_torque{"node {}: no torque in the direction of a limit of 0 %: {}",
                                       "ノード {}: 動作トルク制限が 0 % の方向にはトルクが出ません:"
                                       " {}"};
inline constexpr Text motion_no_speed{"node {}: no motion in the direction of a limit of 0 rpm: {}",
                                      "ノード {}: 動作速度制限が 0 rpm の方向には回転しません: {}"};
inline constexpr Text motion_limit_unproven{
    "; before firmware 1.100 there is no speed_torque_control: only a real servo shows whether the "
    "limit acts",
    "。1.100 より前のファームウェアには speed_torque_control がなく、制限が有効かは実機でのみ"
    "確認できます"};
inline constexpr Text motion_limits_idle{
    "node {}: these limits have no effect while speed_torque_control (0x25) is off: {}",
    "ノード {}: speed_torque_control (0x25) が OFF の間、次の制限は無視されます: {}"};
inline constexpr Text motion_limits_idle_fix{"to use them: {}; else take them back: {}",
                                             "有効にする場合: {}、元に戻す場合: {}"};
inline constexpr Text motion_angle_fixed{
    "node {}: whatever angle is commanded, it stays at 0 deg: both angle limits are 0: {}",
    "ノード {}: 動作角度制限が両方 0 のため、角度指令に関わらず 0° から動作しません: {}"};
inline constexpr Text motion_angle_one_side{
    "node {}: angles on one side of 0 deg are not reached: the limit is 0: {}",
    "ノード {}: 動作角度制限が 0 のため、0° の片側へは動作しません: {}"};
inline constexpr Text motion_beyond{
    "node {} commands node {} to {} ({}), beyond {} {}: it goes to the limit at most",
    "ノード {} はノード {} に {} ({}) を指令していますが、{} {} を超えるため、制限値までしか動作"
    "しません"};
inline constexpr Text motion_held_beyond{
    "node {} has the command {} ({}), beyond {} {}: it goes to the limit at most",
    "ノード {} の指令 {} ({}) は {} {} を超えるため、制限値までしか動作しません"};
inline constexpr Text motion_within_fix{"keep the command within the limit",
                                        "制限内の値を指令して下さい"};
inline constexpr Text motion_widen_fix{
    "keep the command within the limit; or, if the mechanism allows it, {}",
    "制限内の値を指令するか、機構に余裕があれば {}"};

inline constexpr Text motion_set{"blactl set -n {} {}{}", "blactl set -n {} {}{}"};
inline constexpr Text motion_when_stopped{"stop node {}, then: {}", "ノード {} の指令を停止後: {}"};

} // namespace blactl::texts
