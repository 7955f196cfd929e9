#pragma once
// Messages of the diagnoses.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text link_down{"{} is down: nothing can be sent or heard",
                                "{} は停止しています。送受信できません"};
inline constexpr Text link_bit_rate{"{} runs at {} bit/s; BLA servos talk at 1000000",
                                    "{} のビットレートは {} bit/s です (BLA サーボは 1000000)"};
inline constexpr Text link_sample_point{"{} samples each bit at {}.{} %; Futaba asks for 87.5 %",
                                        "{} のサンプルポイントは {}.{} % です (仕様は 87.5 %)"};
inline constexpr Text link_error_warning{
    "the controller of {} has counted many errors ({} sending, {} receiving)",
    "{} のコントローラでエラーが多発しています (送信 {}、受信 {})"};
inline constexpr Text link_error_passive{
    "the controller of {} is error-passive ({} errors sending, {} receiving)",
    "{} のコントローラはエラーパッシブ状態です (送信エラー {}、受信エラー {})"};
inline constexpr Text link_bus_off{"the controller of {} is bus-off: it takes no part any more",
                                   "{} のコントローラはバスオフ状態です。通信に参加していません"};
inline constexpr Text link_no_restart{
    "after bus-off {} stays off until somebody sets it up again (restart-ms 0)",
    "{} はバスオフ後に自動復帰しません (restart-ms 0)"};
inline constexpr Text link_short_queue{"the queue of {} takes {} frames only",
                                       "{} の送信キューは {} フレーム分しかありません"};
inline constexpr Text look_at_wiring{
    "look at the termination (120 ohm at both ends), the cable, and the bit rate of every node",
    "終端抵抗 (両端 120 Ω)、配線、各ノードのビットレートを確認して下さい"};
inline constexpr Text bus_silent{"nothing was heard", "何も受信しませんでした"};
inline constexpr Text bus_silent_fix{
    "look at the supply of the servos, CAN-H and CAN-L, the termination, the bit rate",
    "サーボの電源、CAN-H / CAN-L の配線、終端抵抗、ビットレートを確認して下さい"};
inline constexpr Text log_runs_backwards{
    "the times of the log run backwards: they give neither durations nor the load of the bus",
    "ログの時刻が逆行しています。経過時間とバス負荷は求められません"};
inline constexpr Text log_runs_backwards_fix{
    "take a log of one recording, as it was written: blactl --record FILE",
    "1 回の記録をそのまま使用して下さい: blactl --record FILE"};
inline constexpr Text bus_standard_frames{
    "frames with 11-bit identifiers: {}; something here does not speak DroneCAN",
    "11 ビット ID のフレーム: {} 個。DroneCAN 以外の機器が接続されています"};
inline constexpr Text bus_standard_frames_fix{"see who it is: blactl trace; candump",
                                              "送信元を確認: blactl trace、candump"};
inline constexpr Text bus_loaded{"the bus is busy {}.{} % of the time", "バス負荷は {}.{} % です"};
inline constexpr Text bus_loaded_fix{"see who sends most: blactl trace --stats --duration 5",
                                     "送信量の多いノードを確認: blactl trace --stats --duration 5"};
inline constexpr Text bus_faults{"the controller has reported {}: {}",
                                 "コントローラが {} を {} 回報告しました"};
inline constexpr Text fault_bus_off{"bus-off", "バスオフ"};
inline constexpr Text fault_error_passive{"error-passive", "エラーパッシブ"};
inline constexpr Text fault_error_warning{"many errors", "エラー多発"};
inline constexpr Text fault_no_acknowledge{"frames that nobody acknowledges", "ACK なし"};
inline constexpr Text fault_transmit_timeout{"frames that could not be sent", "送信タイムアウト"};
inline constexpr Text fault_receive_overflow{"frames lost on receiving", "受信オーバーフロー"};
inline constexpr Text fault_protocol{"damaged frames", "プロトコルエラー"};

inline constexpr Text adapter_faults{"the adapter has reported {}",
                                     "アダプターが {} を報告しました"};
inline constexpr Text port_mavlink{
    "this port carries MAVLink: it is not a CAN adapter",
    "このポートで MAVLink を受信しました。CAN アダプターではありません"};
inline constexpr Text port_text{"this port carries text that is not slcan",
                                "このポートで slcan ではないテキストを受信しました"};
inline constexpr Text port_foreign_fix{"use another port: ls -l /dev/serial/by-id",
                                       "別のポートを指定して下さい: ls -l /dev/serial/by-id"};

inline constexpr Text node_bad_health{"node {} says that its health is {}",
                                      "ノード {} の健康状態は「{}」です"};
inline constexpr Text node_bad_health_fix{"see why: blactl faults -n {}",
                                          "原因を確認: blactl faults -n {}"};
inline constexpr Text node_offline{"node {} was heard, and is not any more",
                                   "ノード {} からの受信が途絶えました"};
inline constexpr Text node_offline_fix{"look at its supply and its cable: blactl wait -n {}",
                                       "電源と配線を確認して下さい: blactl wait -n {}"};
inline constexpr Text node_in_mode{"node {} says that its mode is {}",
                                   "ノード {} の動作モードは「{}」です"};
inline constexpr Text node_in_mode_fix{"wait until it is operational: blactl wait -n {}",
                                       "動作中になるまで待機: blactl wait -n {}"};
inline constexpr Text servo_in_mode_fix{
    "wait until it is operational: blactl wait -n {}; or restart it: blactl restart -n {}",
    "動作中になるまで待機: blactl wait -n {}、または再起動: blactl restart -n {}"};
inline constexpr Text answers_lost{
    "{} of {} requests to nodes {} were not answered: frames are lost, or the nodes are too slow",
    "{1} 回の問合せのうち {0} 回に応答がありません (ノード {2})。"
    "フレームの消失または応答の遅れが考えられます"};
inline constexpr Text answers_lost_fix{
    "look at the cable, the termination, the bit rate of every node and how busy the bus is; "
    "see which requests: blactl scan -v",
    "配線、終端抵抗、各ノードのビットレート、バス負荷を確認して下さい。該当の問合せ: blactl scan "
    "-v"};
inline constexpr Text shared_serial_number{"nodes {} have the same serial number {}",
                                           "ノード {} の製造番号が {} で重複しています"};
inline constexpr Text shared_serial_number_fix{
    "compare it with their labels; choose a servo by -n NODE or uid:UID",
    "銘板と照合して下さい。対象は -n ノード ID または uid: で指定できます"};
inline constexpr Text node_mute_status{
    "node {} sends no NodeStatus: others take it for lost after 3 s",
    "ノード {} は NodeStatus を送信していません。他ノードには 3 秒で切断と見なされます"};
inline constexpr Text node_mute_status_fix{"see what it sends: blactl trace --stats --duration 5",
                                           "送信内容を確認: blactl trace --stats --duration 5"};
inline constexpr Text node_slow_status{
    "node {} sends NodeStatus {} ms apart; at most 1000 ms are permitted, and after 3 s without "
    "one "
    "it is taken for lost",
    "ノード {} の NodeStatus の間隔が {} ms です。上限は 1000 ms で、3 秒途切れると切断と"
    "見なされます"};
inline constexpr Text node_slow_status_fix{
    "see how regularly it sends: blactl trace --stats --duration 10; then look at its firmware",
    "送信間隔を確認 (blactl trace --stats --duration 10) し、ファームウェアを点検して下さい"};
inline constexpr Text node_restarted{
    "node {} restarted while it was watched: its uptime began anew",
    "ノード {} は監視中に再起動しました (uptime が 0 に戻りました)"};
inline constexpr Text node_restarted_fix{
    "look at its supply, and at what it remembers of the restart: blactl faults -n {}",
    "電源と再起動の記録を確認: blactl faults -n {}"};
inline constexpr Text node_unknown_model{"the model of node {} is not known: it can only be read",
                                         "ノード {} は機種不明です。読出しのみ可能です"};
inline constexpr Text node_unknown_model_fix{
    "name a profile that fits: --profile MODEL, --profile-dir DIR",
    "合うプロファイルを指定して下さい: --profile MODEL、--profile-dir DIR"};
inline constexpr Text node_may_stall{
    "the firmware {} of node {} may stall the motor at low speed; 1.400 does not",
    "ノード {1} のファームウェア {0} は低速時に停止することがあります (1.400 で修正)"};
inline constexpr Text node_may_stall_fix{"ask Futaba for the newer firmware",
                                         "双葉電子工業に新しいファームウェアを問い合わせて下さい"};
inline constexpr Text node_static_differs{
    "0x46 of node {} is {} in RAM: whether ROM holds that too, which counts after a restart, is "
    "not "
    "known",
    "ノード {} の 0x46 は RAM 上で {} です。再起動後に有効となる ROM の値は不明です"};
inline constexpr Text node_static_differs_fix{
    "make it permanent: blactl save -n {0}; or take it back: blactl set -n {0} static_node_id={0}",
    "この値を保存: blactl save -n {0}、元に戻す: blactl set -n {0} static_node_id={0}"};
inline constexpr Text servo_on_tool_id{
    "node {} is a servo, and 126 and 127 are the node IDs of tools: each of them must evade it",
    "ノード {} はサーボですが、126・127 は設定ツール用のノード ID のため、ツールと競合します"};
inline constexpr Text servo_on_tool_id_fix{
    "give it another one for good: blactl set -n {} static_node_id=N --save",
    "別のノード ID に変更: blactl set -n {} static_node_id=N --save"};
inline constexpr Text units_ask_for_id{"units that ask for a node ID and get none: {} or more",
                                       "ノード ID の割当てを待つ機器: {} 台以上"};
inline constexpr Text units_ask_for_id_fix{
    "`blactl alloc --once` gives them one for now, or for good: "
    "blactl alloc --static -n {} --range 11-40",
    "一時的な割当ては `blactl alloc --once`、固定: blactl alloc --static -n {} --range 11-40"};
inline constexpr Text several_allocators{"several nodes allocate node IDs: {}",
                                         "複数のノードが ID を割り当てています: {}"};
inline constexpr Text several_allocators_fix{"end all of them but one",
                                             "1 台を残して停止して下さい"};
inline constexpr Text says_vehicle_armed{"node {} says that the vehicle is armed",
                                         "ノード {} が armed を送信しています"};
inline constexpr Text says_vehicle_armed_fix{"disarm before anything is written",
                                             "書込みの前に disarm して下さい"};
inline constexpr Text somebody_commands{"node {} commands servos",
                                        "ノード {} がサーボに動作指令しています"};
inline constexpr Text somebody_commands_fix{
    "if it shall not move them, or before anything is written: stop it",
    "意図しない場合、または書込みの前に停止して下さい"};
inline constexpr Text commanded_nobody{"node {} commands servo ID {}, which no servo here has",
                                       "ノード {} はサーボ ID {} に指令していますが、該当なしです"};
inline constexpr Text commanded_nobody_fix{"give a servo this ID: blactl set -n NODE servo_id={} "
                                           "--save (ArduPilot's SERVO1 is servo ID 1)",
                                           "サーボに ID を設定: blactl set -n NODE servo_id={} "
                                           "--save (ArduPilot の SERVO1 はサーボ ID 1)"};
inline constexpr Text commanded_pwm{
    "node {} commands servo ID {} by the type PWM ({}), which BLA servos do not take",
    "ノード {} はサーボ ID {} に PWM 型 ({}) で指令していますが、BLA サーボは対応していません"};
inline constexpr Text commanded_pwm_fix{
    "let it send positions or UNITLESS (ArduPilot: CAN_Dn_UC_OPTION without UseActuatorPWM)",
    "POSITION または UNITLESS で送信して下さい (ArduPilot: CAN_Dn_UC_OPTION の UseActuatorPWM "
    "を解除)"};
inline constexpr Text unitless_limited{
    "node {} is commanded in UNITLESS, where 1 is 180 deg, and its limits are {} and {}: beyond "
    "them it stands still",
    "ノード {} は UNITLESS (1 = 180°) で指令されていますが、角度リミットは {} / {} です。"
    "範囲外では停止します"};
inline constexpr Text unitless_limited_fix{
    "scale the commands, or see the limits: blactl get -n {} angle_limit_cw angle_limit_ccw",
    "指令値を調整するか、リミットを確認: blactl get -n {} angle_limit_cw angle_limit_ccw"};

} // namespace blactl::texts
