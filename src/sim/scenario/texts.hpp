#pragma once
// Messages of the simulator.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text scenario_model_unknown{"no model is called \"{}\"; there are {}",
                                             "\"{}\" という機種はありません。あるのは {} です"};
inline constexpr Text scenario_unique_id{"a unique ID has 32 hexadecimal digits",
                                         "固有 ID は 16 進数 32 桁です"};
inline constexpr Text scenario_node_name{"a node name has 1 to 80 bytes",
                                         "ノード名は 1～80 バイトです"};
inline constexpr Text scenario_own_key{"{} is set by the key \"{}\" of the servo",
                                       "{} はサーボのキー \"{}\" で設定します"};
inline constexpr Text scenario_no_memory{"{} holds no value to begin with",
                                         "{} には初期値を設定できません"};
inline constexpr Text scenario_not_in_model{"{} does not exist in {}", "{} は {} にありません"};
inline constexpr Text scenario_pwm_mode{
    "the unit is that of pwm_mode={}; this servo has pwm_mode={}",
    "この単位は pwm_mode={} のものです。このサーボは pwm_mode={} です"};
inline constexpr Text scenario_value_kind{"a value is a number or a string",
                                          "値は数値または文字列です"};
inline constexpr Text scenario_duration{"a time of 0 s to {} s is possible here",
                                        "ここで設定できる時間は 0～{} s です"};
inline constexpr Text scenario_not_in_rom{"{} is not kept in ROM", "{} は ROM に保存されません"};
inline constexpr Text scenario_servo_ids{"an ArrayCommand has 1 to 15 servo IDs",
                                         "ArrayCommand のサーボ ID は 1～15 個です"};

inline constexpr Text scenario_no_such_serial{"no servo of this scenario has the serial number {}",
                                              "製造番号 {} のサーボはこのシナリオにありません"};
inline constexpr Text scenario_event_object{"an event has a \"servo\" or \"clients\"",
                                            "イベントには \"servo\" か \"clients\" が必要です"};
inline constexpr Text scenario_event_servo{
    "an event of a servo has a \"world\" or says what \"happens\"",
    "サーボのイベントには \"world\" か \"happens\" が必要です"};
inline constexpr Text scenario_firmware{"{} never had firmware {}; there were {}",
                                        "{} にファームウェア {} はありません。あるのは {} です"};
inline constexpr Text world_key{"nothing around a servo is called \"{}\"",
                                "サーボの周囲に \"{}\" という項目はありません"};
inline constexpr Text world_word{"{} cannot be \"{}\"", "{} に \"{}\" は設定できません"};
inline constexpr Text world_words{"there are {}", "指定できるのは {} です"};

inline constexpr Text sim_folder{"{} cannot hold the simulator's socket: {}",
                                 "{} にシミュレータのソケットを置けません: {}"};
inline constexpr Text sim_folder_foreign{"it is not a folder of this user alone",
                                         "このユーザー専用のフォルダではありません"};
inline constexpr Text sim_folder_hint{
    "remove it, or set XDG_RUNTIME_DIR to a folder of your own",
    "削除するか、XDG_RUNTIME_DIR に自分のフォルダを設定して下さい"};
inline constexpr Text sim_not_a_socket{"{} exists and is not a socket",
                                       "{} はソケットではありません"};
inline constexpr Text sim_running{"a simulator already serves {}",
                                  "{} では既にシミュレータが動いています"};
inline constexpr Text sim_running_as{"a simulator already serves {}: process {}",
                                     "{} では既にシミュレータが動いています: プロセス {}"};
inline constexpr Text sim_running_hint{
    "use it with `blactl -i sim: scan`, or stop it with Ctrl-C",
    "`blactl -i sim: scan` で利用するか、Ctrl-C で停止して下さい"};
inline constexpr Text sim_cannot_serve{"cannot serve {}: {}", "{} を開始できません: {}"};

} // namespace blactl::texts
