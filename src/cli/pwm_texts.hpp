#pragma once
// Messages of `blactl pwm-config`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text pwm_one_way{
    "choose one of three ways: --endpoints, --preset, or --neutral, --range, --output, --mode",
    "--endpoints、--preset、または --neutral / --range / --output / --mode "
    "のいずれか一つの方法で指定して下さい"};
inline constexpr Text pwm_one_way_hint{"for example --preset 1, or --range 700us --output 70deg",
                                       "例: --preset 1、または --range 700us --output 70deg"};
inline constexpr Text pwm_drawn{"the drawing is in {}", "変換特性の図を {} に書き込みました"};
inline constexpr Text pwm_mode_needs_output{
    "--mode {} without --output: the output range counts in the unit of the mode",
    "--mode {} には --output も必要です (出力範囲の単位が動作モードで変わるため)"};
inline constexpr Text pwm_mode_hint{
    "for example --mode angle --output 70deg or --mode speed --output 150rpm",
    "例: --mode angle --output 70deg、--mode speed --output 150rpm"};
inline constexpr Text pwm_output_symmetric{
    "--output {}: the range is the same to either side, so it is one positive value",
    "--output {}: 出力範囲は両側対称です。正の値を一つ指定して下さい"};
inline constexpr Text pwm_output_hint{"for example --output 70deg", "例: --output 70deg"};
inline constexpr Text pwm_nothing_to_change{"{}: nothing to change is given",
                                            "{}: 変更内容の指定がありません"};
inline constexpr Text pwm_nothing_hint{
    "say what: --neutral, --range, --output, --mode, --endpoints or --preset",
    "--neutral、--range、--output、--mode、--endpoints、--preset のいずれかを指定して下さい"};
inline constexpr Text pwm_svg_one_servo{"--svg draws one servo, not {}",
                                        "--svg で描画できるのは 1 台です ({} 台指定)"};
inline constexpr Text pwm_svg_to_stdout{"--svg needs a file: standard output is for data",
                                        "--svg にはファイルを指定して下さい "
                                        "(標準出力はデータ用です)"};
inline constexpr Text pwm_svg_file_hint{"for example --svg mapping.svg", "例: --svg mapping.svg"};
inline constexpr Text pwm_svg_hint{"choose one with -n", "-n で 1 台選んで下さい"};
inline constexpr Text pwm_unknown{"the PWM mapping is not known", "PWM の設定を取得できません"};
inline constexpr Text pwm_pulses{"  pulses   {} us +-{} us: {} to {} us\n",
                                 "  パルス幅  {} us ±{} us: {} ～ {} us\n"};
inline constexpr Text pwm_output{"  command  +-{} ({})\n", "  指令値    ±{} ({})\n"};
inline constexpr Text pwm_angle{"angle", "角度"};
inline constexpr Text pwm_speed{"speed", "速度"};
inline constexpr Text pwm_input_now{"  input    {}\n", "  現在入力  {}\n"};
inline constexpr Text pwm_input_ok{"a pulse within the range", "入力範囲内のパルスあり"};
inline constexpr Text pwm_input_none{"no pulse", "パルス無し"};
inline constexpr Text pwm_input_short{"a pulse at or below the shortest",
                                      "入力範囲の下限以下のパルスあり"};
inline constexpr Text pwm_input_long{"a pulse at or above the longest",
                                     "入力範囲の上限以上のパルスあり"};
inline constexpr Text pwm_fallback{
    "  CAN      has priority; PWM is accepted after {} ms without CAN commands\n",
    "  CAN 指令  優先。{} ms (timeout_time) 以上途絶えると PWM を受け付けます\n"};
inline constexpr Text pwm_idle{
    "  speed    pulses have no effect while speed_torque_control is off\n",
    "  速度指令  speed_torque_control が OFF の間、PWM では動作しません\n"};
inline constexpr Text pwm_cut_below{"  limit    below {} us it stays at {}\n",
                                    "  制限      {} us 未満では {} にとどまります\n"};
inline constexpr Text pwm_cut_above{"  limit    above {} us it stays at {}\n",
                                    "  制限      {} us を超えると {} にとどまります\n"};
inline constexpr Text pwm_beyond{"  beyond   a pulse out of this range counts as no pulse\n",
                                 "  範囲外    パルス無しと同じ扱いになります\n"};
inline constexpr Text pwm_legend{"{} within the limits   {} what the limits cut off",
                                 "{} 制限内の指令値   {} 制限により無効な部分"};
inline constexpr Text pwm_drawing_legend{"blue: within the limits; red, dashed: without limits",
                                         "青: 制限内の指令値、赤の破線: 制限がない場合"};
inline constexpr Text pwm_missed{"none: counts as no pulse", "無し (パルス無しと同じ)"};
inline constexpr Text pwm_after_dry_run{"\n  after (--dry-run: nothing was written)\n",
                                        "\n  変更後 (--dry-run のため書き込んでいません)\n"};
inline constexpr Text pwm_before{"  before   {}\n", "  変更前    {}\n"};
inline constexpr Text column_pulse{"PULSE", "パルス幅"};
inline constexpr Text column_command{"COMMAND", "指令値"};
inline constexpr Text pwm_limited_to{", limited to {}", " ({} に制限)"};
inline constexpr Text pwm_neutral_point{"neutral", "ニュートラル"};
inline constexpr Text pwm_shortest_point{"shortest", "下限"};
inline constexpr Text pwm_longest_point{"longest", "上限"};
inline constexpr Text pwm_limit_point{"limit", "動作制限"};
inline constexpr Text pwm_autopilot_point{"usual autopilot pulse", "フライトコントローラの標準値"};

} // namespace blactl::texts
