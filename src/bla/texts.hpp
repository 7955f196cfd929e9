#pragma once
// The text catalogue of the floor `bla`: profiles, parameters and values.

#include "blactl/base/text.hpp"

namespace blactl::texts {

// Names of parameters
inline constexpr Text parameter_unknown{"{}: there is no such parameter",
                                        "{}: そのようなパラメータはありません"};
inline constexpr Text parameter_reserved{
    "{} is a reserved address: blactl neither reads nor writes it",
    "{} は Reserve です。blactl は読み書きしません"};
inline constexpr Text parameter_list{
    "`blactl get` lists the parameters of your servo, `blactl models all` those of every model",
    "`blactl get` でお使いのサーボ、`blactl models all` で全機種のパラメータを確認できます"};
inline constexpr Text list_and_more{", ", "、"};
inline constexpr Text list_or{" or ", " または "};

// Values as typed: the first argument of each is PARAM=VALUE
inline constexpr Text assignment_without_equals{"{}: not of the form PARAM=VALUE",
                                                "{}: PARAM=VALUE の形式ではありません"};
inline constexpr Text assignment_example{"for example {}", "例: {}"};
inline constexpr Text assignment_example_of{"for example {} for a {}", "例: {} ({} の場合)"};
inline constexpr Text value_not_a_number{"{}: not a number", "{}: 数値ではありません"};
inline constexpr Text value_grammar{"a number is written [-]digits[.digits]unit, {}",
                                    "数値は [-]数字[.数字]単位 の形で入力して下さい。{}"};
inline constexpr Text value_not_whole{"{}: a register number has no decimals",
                                      "{}: レジスタ値に小数は使えません"};
inline constexpr Text value_without_unit{"{}: the unit is missing", "{}: 単位がありません"};
inline constexpr Text value_type{"type {}", "{} と入力して下さい"};
inline constexpr Text value_wrong_unit{"{}: the unit {} does not fit, this parameter takes {}",
                                       "{}: 単位 {} は使えません。使える単位は {} です"};
inline constexpr Text value_has_no_unit{"{}: this parameter has no unit",
                                        "{}: このパラメータに単位はありません"};
inline constexpr Text value_too_fine{"{}: the register counts in steps of {}",
                                     "{}: レジスタの分解能は {} です"};
inline constexpr Text value_unknown_word{"{}: unknown word, this parameter takes {}",
                                         "{}: 不明な語です。使える語は {} です"};
inline constexpr Text value_no_choice{"{}: there is no such setting, this parameter takes {}",
                                      "{}: そのような設定はありません。使える値は {} です"};
inline constexpr Text value_beyond_64_bits{"{}: larger than any register",
                                           "{}: レジスタに収まらない値です"};
inline constexpr Text value_out_of_range{"{}: outside of the range {} to {}",
                                         "{}: 設定範囲 {} ～ {} の外です"};
inline constexpr Text value_only_one{"{}: only {} is possible", "{}: 設定できる値は {} だけです"};
inline constexpr Text value_in_a_gap{"{}: outside of the ranges of all models",
                                     "{}: どの機種の設定範囲にもありません"};
inline constexpr Text value_one_range{"{} to {}", "{} ～ {}"};
inline constexpr Text value_ranges_hint{"the models take {}", "各機種の設定範囲: {}"};
inline constexpr Text value_range_hint{"type a value from {} to {}",
                                       "{} ～ {} の値を入力して下さい"};
inline constexpr Text value_not_active{"not active", "無効 (他種の指令中)"};

// The PWM mapping
inline constexpr Text pwm_endpoint_form{"{}: not of the form PULSE:VALUE,PULSE:VALUE",
                                        "{}: PULSE:VALUE,PULSE:VALUE の形式ではありません"};
inline constexpr Text pwm_endpoint_unit{"{}: the value needs a unit, deg or rpm",
                                        "{}: 値に単位 deg または rpm が必要です"};
inline constexpr Text pwm_endpoints_example{"for example --endpoints 500us:-70deg,1500us:70deg",
                                            "例: --endpoints 500us:-70deg,1500us:70deg"};
inline constexpr Text pwm_endpoints_differ{
    "--endpoints: the two pulses must differ, and both values must be in the same unit",
    "--endpoints: パルス幅は異なる値、単位は同じものを指定して下さい"};
inline constexpr Text pwm_endpoints_fall{
    "--endpoints: the longer pulse always gives the greater value (clockwise)",
    "--endpoints: パルス幅が広いほど大きい値 (CW 方向) になります"};
inline constexpr Text pwm_endpoints_fall_hint{
    "swap the values, and turn the direction with: blactl set reverse=on",
    "値を入れ替え、回転方向は blactl set reverse=on で反転して下さい"};
inline constexpr Text pwm_asymmetric{
    "--endpoints: the output is symmetric: give its two ends, for example -90deg and 90deg",
    "--endpoints: 出力範囲は正負対称です。両端を -90deg と 90deg のように指定して下さい"};
inline constexpr Text pwm_same_line{"through both points, for pulses from {} to {} us: {}",
                                    "指定の 2 点を通る設定 (パルス幅 {}～{} us): {}"};
inline constexpr Text pwm_half_neutral{
    "--endpoints: the middle between the pulses is not a whole microsecond",
    "--endpoints: パルス幅の中央が整数 (us) になりません"};
inline constexpr Text pwm_nearest{"the nearest that is possible: --endpoints {}",
                                  "設定可能な最も近い値: --endpoints {}"};

// Refusals that hold for every servo
inline constexpr Text assigned_twice{"{} is given twice", "{} が 2 回指定されています"};
inline constexpr Text assigned_twice_hint{"name each parameter once",
                                          "パラメータは 1 回だけ指定して下さい"};
inline constexpr Text pwm_unit_against_servo{"{}: this servo has {}, the unit is {}",
                                             "{}: このサーボは {} のため、単位は {} です"};
inline constexpr Text pwm_either_unit{"type {}, or {}", "{} または {} と入力して下さい"};
inline constexpr Text pwm_unit_against_mode{"{}: with {} the unit is {}",
                                            "{}: {} では単位は {} です"};
inline constexpr Text is_read_only{"{} ({}) can only be read", "{} ({}) は読出し専用です"};
inline constexpr Text is_read_only_hint{"`blactl get {}` shows it",
                                        "`blactl get {}` で値を確認できます"};
inline constexpr Text bootloader_refused{
    "0x49 starts the boot loader: the specification forbids writing it",
    "0x49 はブートローダ起動です。仕様書で書込みが禁止されています"};
inline constexpr Text operation_refused{"{} ({}) is an operation, not a setting",
                                        "{} ({}) は設定ではなく操作です"};
inline constexpr Text operation_hint{"use `blactl {}`", "`blactl {}` を使って下さい"};
inline constexpr Text node_id_of_tools{
    "{}: the node IDs 126 and 127 belong to tools such as blactl",
    "{}: ノード ID 126 と 127 は blactl などのツール用です"};
inline constexpr Text node_ids_of_tools_remark{
    "126 and 127 are reserved for tools such as blactl: they are never written",
    "126 と 127 は blactl などのツール用に確保されているため、書き込めません"};
inline constexpr Text node_id_hint{"type an ID from 1 to 125, or 0 for dynamic allocation",
                                   "1～125、または 0 (動的割当て) を入力して下さい"};

// Refusals that depend on the servo
inline constexpr Text model_unknown{
    "no profile fits this servo ({}): it is only read",
    "このサーボ ({}) に合うプロファイルが無いため、読出しのみ可能です"};
inline constexpr Text model_unknown_hint{
    "add a profile for this model with --profile-dir DIR",
    "--profile-dir DIR でこの機種のプロファイルを追加して下さい"};
inline constexpr Text default_unknown{
    "the model is not known well enough to give the default of {}",
    "機種を特定できないため、{} の初期値が不明です"};
inline constexpr Text model_not_certain{
    "{} ({}) depends on the model, and {} fits more than one: {}",
    "{} ({}) の範囲は機種によりますが、{} から機種を特定できません (候補: {})"};
inline constexpr Text model_mismatch{"the servo is {}, not {}",
                                     "サーボの機種は {} で、{} ではありません"};
inline constexpr Text model_mismatch_hint{"leave --profile out", "--profile を外して下さい"};
inline constexpr Text number_unknown{"unknown", "不明"};
inline constexpr Text firmware_needed{
    "{} ({}) needs firmware {}, this servo has {}",
    "{} ({}) にはファームウェア {} 以降が必要です (このサーボは {})"};
inline constexpr Text firmware_unknown{
    "{} ({}) needs firmware {}, and this servo does not report its own",
    "{} ({}) にはファームウェア {} 以降が必要ですが、このサーボのバージョンは不明です"};
inline constexpr Text firmware_unknown_hint{"`blactl get firmware_version` reads it",
                                            "`blactl get firmware_version` で確認して下さい"};
inline constexpr Text firmware_needed_hint{
    "`blactl models {}` shows which firmware has which features",
    "`blactl models {}` でファームウェアごとの機能を確認できます"};
inline constexpr Text model_lacks{"{} has no parameter {} ({})",
                                  "{} にパラメータ {} ({}) はありません"};
inline constexpr Text no_pwm_input{"{} has no PWM input", "{} に PWM 入力はありません"};
inline constexpr Text no_pwm_parameter{
    "{} has no PWM input: {} ({}) can only be 0",
    "{} に PWM 入力はないため、{} ({}) に設定できる値は 0 だけです"};
inline constexpr Text no_pwm_input_hint{
    "{} is driven over CAN alone; which models have a PWM input: `blactl models`",
    "{} は CAN 通信専用です。PWM 入力対応機種は `blactl models` で確認できます"};
inline constexpr Text pwm_models_take{"models with a PWM input take {}",
                                      "PWM 入力対応機種の設定範囲: {}"};

inline constexpr Text one_command_only{
    "command_angle, command_speed and command_torque exclude each other",
    "command_angle、command_speed、command_torque は同時に指定できません",
};
inline constexpr Text one_command_only_hint{
    "the servo obeys the last one: give just that",
    "最後の指令だけが有効になるため、一つだけ指定して下さい"};

// Profile files: faults
inline constexpr Text profile_directory{"cannot read the profiles in {}: {}",
                                        "{} のプロファイルを読み込めません: {}"};
inline constexpr Text profile_directory_hint{
    "check --profile-dir or BLACTL_PROFILE_DIR",
    "--profile-dir または BLACTL_PROFILE_DIR を確認して下さい"};
inline constexpr Text profile_bad_address{"{} is not an address; addresses are 0x00 to 0x5F",
                                          "{} はアドレスではありません (0x00～0x5F)"};
inline constexpr Text profile_bad_name{"{} is not a valid name; names have only a-z, 0-9 and _",
                                       "{} は名前に使えません (a-z、0-9、_ のみ)"};
inline constexpr Text profile_bad_model_part{
    "{} is not a valid part of a model name; use A-Z and digits",
    "{} は機種名に使えません (A-Z と数字のみ)"};
inline constexpr Text profile_empty_text{"the text is empty", "文字列が空です"};
inline constexpr Text profile_name_twice{"{} is already the name of {}", "{} は {} の名前です"};
inline constexpr Text profile_range_incomplete{"min and max belong together",
                                               "min と max は両方必要です"};
inline constexpr Text profile_range_reversed{"min {} is greater than max {}",
                                             "min {} が max {} より大きくなっています"};
inline constexpr Text profile_default_outside{"default {} lies outside of {} to {}",
                                              "default {} が {} ～ {} の外です"};
inline constexpr Text profile_range_per_model{
    "a per_model register has its values in the series files",
    "per_model の値はシリーズのファイルに書いて下さい"};
inline constexpr Text profile_writable_without_range{"a register that can be written needs {}",
                                                     "書込み可能なレジスタには {} が必要です"};
inline constexpr Text profile_choice_twice{"{} occurs twice among the choices",
                                           "choices に {} が重複しています"};
inline constexpr Text profile_unknown_register{"the family has no register {}",
                                               "ファミリーにレジスタ {} はありません"};
inline constexpr Text profile_set_by_model{"{} follows from model_number and hardware_version",
                                           "{} は model_number と hardware_version で決まります"};
inline constexpr Text profile_no_such_section{"{} is not among the {}", "{} は {} にありません"};
inline constexpr Text profile_register_missing{"{}: {} ({}) has no default, min and max",
                                               "{}: {} ({}) の default、min、max がありません"};
inline constexpr Text profile_model_twice{"the model {} is described twice",
                                          "機種 {} が重複しています"};
inline constexpr Text profile_like_another{"{} has the model number and hardware version of {}",
                                           "{} の機種番号とハードウェアバージョンが {} と同じです"};
inline constexpr Text profile_described_otherwise{
    "{} ({}) is not described as {} ({}) of another series: only default, min and max may differ",
    "{} ({}) の定義が別のシリーズの {} ({}) と異なります (default、min、max だけが変更できます)"};
inline constexpr Text profile_bit_twice{"{} bit {} is described twice",
                                        "{} の bit {} が重複しています"};
inline constexpr Text profile_no_summary_bit{"0x18 has no bit {}", "0x18 に bit {} はありません"};
inline constexpr Text profile_code_twice{"the code {} is used twice", "code {} が重複しています"};
inline constexpr Text profile_bit_group{"bit {} belongs to the group {}",
                                        "bit {} はグループ {} に属します"};
inline constexpr Text profile_releases_order{"versions must ascend",
                                             "version は昇順でなければなりません"};
inline constexpr Text profile_bad_month{"{} is not a month like 2024-06",
                                        "{} は 2024-06 の形式ではありません"};
inline constexpr Text profile_second_family{"there is already a family, in {}",
                                            "ファミリーは既に {} にあります"};
inline constexpr Text profile_no_family{"no file describes the family",
                                        "ファミリーのファイルがありません"};

inline constexpr Text made{"made {}", "製造日時 {}"};
inline constexpr Text unknown_bit{"Undocumented bit", "仕様書に記載のないビット"};

// Reasons of cross-checks
inline constexpr Text check_control_off{
    "the servo takes no speed or torque while speed_torque_control (0x25) is off",
    "speed_torque_control (0x25) が OFF の間、指令速度/指令トルクは無視されます"};
inline constexpr Text check_no_stop{
    "with timeout_action=hold (0x26) nothing stops a speed or torque command when the sender "
    "falls silent",
    "timeout_action=hold (0x26) では、送信元が停止しても指令速度/指令トルクの動作が継続します"};
inline constexpr Text check_limits_reversed{
    "the upper limit must be above the lower one, or the motor is always off",
    "上限は下限より大きい値でなければなりません (モータが常に停止します)"};
inline constexpr Text check_always_asked{"any change can move the shaft or let go of the load",
                                         "変更により出力軸の動作または脱力の可能性があります"};
inline constexpr Text check_soft_start_ends{
    "this ends a soft start that is still under way: with the output on the shaft may then run to "
    "0 deg at full speed",
    "ソフトスタート中の場合は終了し、出力が ON であれば出力軸が全速で 0° へ動く可能性があります"};
inline constexpr Text check_pulled_back{"the shaft is beyond the limit: it runs back to it",
                                        "現在角度が制限を超えているため、制限角度まで動作します"};
inline constexpr Text check_let_go_on{
    "a command beyond the old limit is still there: the shaft runs on to it",
    "変更前の制限を超える指令が残っているため、その角度まで動作します"};
inline constexpr Text check_no_torque{"with a torque limit of 0 % the servo lets go of the load",
                                      "動作トルク制限が 0 % の場合、負荷を保持できません"};
inline constexpr Text check_no_torque_later{
    "it has no effect while speed_torque_control (0x25) is off; with it on the servo lets go of "
    "the load",
    "speed_torque_control (0x25) が OFF の間は無視されますが、ON にすると負荷を保持できません"};
inline constexpr Text check_limits_without_effect{
    "the limits of speed and torque (0x3A-0x3D) have no effect while speed_torque_control (0x25) "
    "is off; to use them, set speed_torque_control=on",
    "動作速度制限/動作トルク制限 (0x3A～0x3D) は、speed_torque_control (0x25) が OFF の間は"
    "無視されます。有効にするには speed_torque_control=on を設定して下さい"};
inline constexpr Text check_temperature_trips{
    "the present temperature is at the limit or beyond it: the motor may be switched off at once",
    "現在の温度が制限に達しているため、直ちにモータが停止することがあります"};
inline constexpr Text check_voltage_trips{
    "the present voltage is at the limit or beyond it: the motor may be switched off at once",
    "現在の電圧が制限に達しているため、直ちにモータが停止することがあります"};
inline constexpr Text check_protection_released{
    "the protection that holds the motor off ends: torque comes back",
    "モータを停止させている保護が解除され、トルクが復帰します"};
inline constexpr Text check_pwm_present{
    "a PWM signal is present: the shaft follows the new mapping",
    "PWM 信号が入力されているため、新しい設定に従って動作します"};
inline constexpr Text check_pwm_cut_off{
    "the PWM output range reaches beyond the angle limits: the shaft stops at the limit",
    "PWM の出力範囲が動作角度制限を超えています。出力軸は制限角度で停止します"};
inline constexpr Text check_pwm_needs_switch{
    "PWM in speed mode moves nothing while speed_torque_control (0x25) is off",
    "speed_torque_control (0x25) が OFF の間、PWM の速度指令では動作しません"};
inline constexpr Text check_pwm_speed_limited{
    "the PWM output range exceeds the speed limits: the speed stays at the limit",
    "PWM の出力範囲が動作速度制限を超えています。速度は制限値にとどまります"};
inline constexpr Text check_no_motion{"the range of motion is 0: nothing moves",
                                      "動作範囲が 0 のため動作しません"};
inline constexpr Text check_pwm_below_zero{
    "the range reaches below 0 us: that end of the output cannot be reached",
    "入力範囲の下限が 0 us 未満になります。その側の端までは動作しません"};
inline constexpr Text check_dead_band_zero{
    "without a dead band the servo may hunt and heat up",
    "デッドバンドが 0 の場合、ハンチングや発熱の可能性があります"};
inline constexpr Text check_near_supply{
    "the present supply is less than 0.5 V away: a dip or a peak under load switches the motor "
    "off",
    "現在電圧との差が 0.5 V 未満です。負荷変動でモータが停止する可能性があります"};
inline constexpr Text check_timeout_short{
    "shorter than 100 ms: a few commands that come late are taken for a loss of communication",
    "100 ms 未満では、指令の遅れを通信途絶と判定する可能性があります"};
inline constexpr Text check_servo_id_of_all{
    "0 is the factory setting: a command to 0 may move every servo that has it",
    "0 は工場出荷時の値です。0 宛の指令で、同じ値の全サーボが動作する可能性があります"};
inline constexpr Text check_leave_at_default{"the manufacturer advises to leave it at its default",
                                             "メーカーは初期値のままとすることを推奨しています"};
inline constexpr Text check_hard_start{
    "when the servo starts, torque comes on at once where the shaft is, and the first command is "
    "followed at full speed",
    "起動時に現在位置で直ちにトルクが ON になり、最初の指令に全速で動作します"};
inline constexpr Text check_low_speed_stall{
    "firmware before 1.400 may stall at low speed",
    "1.400 より前のファームウェアは低速動作時にストールすることがあります"};

} // namespace blactl::texts
