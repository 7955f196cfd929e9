#pragma once
// Messages of commands to the shaft of a servo.

#include "blactl/base/text.hpp"

namespace blactl::texts {

// Reasons for not commanding.

inline constexpr Text motion_output_off{
    "node {}: torque_output (0x20) is {}: the shaft follows no command",
    "ノード {}: torque_output (0x20) が {} のため、出力軸は指令に従いません"};
inline constexpr Text motion_beyond_limits{
    "node {}: {} is beyond its limits {} ({}) and {} ({}): it would stay at the limit",
    "ノード {}: {} は制限 {} ({}) ～ {} ({}) の範囲外です。指令しても制限値にとどまります"};
inline constexpr Text motion_beyond_limits_hint{
    "command less, or see the limits: blactl get -n {} --group limit",
    "指令値を制限の範囲内にするか、制限を確認して下さい: blactl get -n {} --group limit"};
inline constexpr Text motion_outside{
    "node {}: the shaft is at {}, outside of its limits {} and {}: it could not be held on its way",
    "ノード {}: 現在角度 {} が動作角度制限 {} ～ {} の範囲外のため、途中で保持できません"};
inline constexpr Text motion_outside_hint{
    "widen the limits, or move it without a stop on its way: blactl set -n {} command_angle=0deg",
    "制限を広げるか、次のコマンドで動かして下さい (途中で停止できません): blactl set -n {} "
    "command_angle=0deg"};
inline constexpr Text motion_no_room{
    "node {}: at {} its limits {} and {} leave no room to wiggle",
    "ノード {}: 現在角度 {} では、動作角度制限 {} ～ {} の範囲内に往復動作の余裕がありません"};
inline constexpr Text motion_no_room_hint{"see the limits: blactl get -n {} --group limit",
                                          "制限の確認: blactl get -n {} --group limit"};
inline constexpr Text motion_timeout_short{
    "node {}: timeout_time (0x27) is {}: no bus carries a command in every half of that",
    "ノード {}: timeout_time (0x27) が {} のため、その半分以下の周期で指令を送信できません"};
inline constexpr Text motion_not_exact{
    "ArrayCommand cannot carry {} exactly: its numbers have half precision, the nearest is {}",
    "ArrayCommand では {} を正確に送信できません (半精度浮動小数点、最も近い値は {})"};
inline constexpr Text motion_not_exact_hint{"leave --array out, or command {}",
                                            "--array を外すか、{} を指令して下さい"};
inline constexpr Text motion_servo_id_shared{
    "nodes {} and {} both have servo ID {}: an ArrayCommand would move both",
    "ノード {} と {} のサーボ ID が {} で重複しています。ArrayCommand では両方が動作します"};
inline constexpr Text motion_servo_id_unknown{
    "node {} did not report its servo ID: it may be {}, too",
    "ノード {} のサーボ ID を確認できません。対象と同じ {} の可能性があります"};
inline constexpr Text motion_servo_id_pending{
    "a unit waits for a node ID: its servo ID is not known, and may be {}, too",
    "ノード ID 割当て待ちの機器があり、そのサーボ ID は不明です。対象と同じ {} の可能性があります"};
inline constexpr Text motion_servo_id_hint{
    "leave --array out: 0x00-0x02 of the node reach just this servo",
    "--array を外して下さい。ノードの 0x00～0x02 への書込みであれば、対象のサーボだけに届きます"};
inline constexpr Text motion_servo_id_later{
    "node {}: servo_id (0x45) is {}, but it reports {}: the change may take effect at the next "
    "start",
    "ノード {}: servo_id (0x45) は {} ですが、サーボは {} を送信しています。変更は次の起動から"
    "有効になる可能性があります"};
inline constexpr Text motion_servo_id_later_hint{
    "save it, which restarts the servo (blactl save -n {}), or leave --array out",
    "保存して再起動する (blactl save -n {}) か、--array を外して下さい"};
inline constexpr Text motion_changed{
    "node {}: {} is {}, not {} as a moment ago: nothing was commanded",
    "ノード {}: {} が先ほどと異なるため ({}、直前は {})、指令していません"};

// The question.

inline constexpr Text motion_question_angle{
    "This moves the shaft of node {}: from {} to {}. After {} s it is held there; {}.\n",
    "ノード {} の出力軸を {} から {} に動かします。{} 秒後にその角度で保持します。{}。\n"};
inline constexpr Text motion_question_speed{
    "This turns the shaft of node {} at {} for {} s, from {} on. Then it is stopped; {}.\n",
    "ノード {} の出力軸を {} で {} 秒間回転させます (現在角度 {})。その後停止します。{}。\n"};
inline constexpr Text motion_question_torque{
    "This pushes the shaft of node {} with {} for {} s, from {} on. Then it is stopped; {}.\n",
    "ノード {} の出力軸に {} のトルクを {} 秒間加えます (現在角度 {})。その後停止します。{}。\n"};
inline constexpr Text motion_question_wiggle{
    "This moves the shaft of node {} to and fro by up to {} for {} s, around {}. Then it is held "
    "there; "
    "{}.\n",
    "ノード {} の出力軸を ±{} 以内で {} 秒間往復させます (現在角度 {})。"
    "その後、元の角度で保持します。"
    "{}。\n"};
inline constexpr Text motion_question_pwm{
    "A PWM signal is present: it commands the servo again after that.\n",
    "PWM 信号が入力されているため、その後は再び PWM 信号の指令に従います。\n"};
inline constexpr Text motion_question_fault{
    "Present: {}. The motor may be off.\n",
    "発生中の異常: {}。モータ出力が OFF の可能性があります。\n"};

inline constexpr Text motion_then_hold{"{} after the last command nothing changes (hold)",
                                       "最後の指令から {} 経過後も最終指令状態を保持します (hold)"};
inline constexpr Text motion_then_off{
    "{} after the last command the output goes off (off): it lets go of the load",
    "最後の指令から {} 経過すると出力が OFF になり、負荷を保持できなくなります (off)"};
inline constexpr Text motion_then_brake{
    "{} after the last command the output brakes (brake)",
    "最後の指令から {} 経過するとブレーキ状態になります (brake)"};

inline constexpr Text motion_then_unknown{
    "without commands it acts as its ROM says, which is not known",
    "指令が途絶えた場合の動作は ROM の設定によります (内容は不明)"};

// The end.

inline constexpr Text motion_silent{"node {}: it does not answer any more while it is commanded",
                                    "ノード {}: 指令中に応答しなくなりました"};
inline constexpr Text motion_restarted{"node {}: it restarted while it was commanded",
                                       "ノード {}: 指令中に再起動しました"};
inline constexpr Text motion_restarted_hint{
    "look at its supply; whether it restarts again: blactl monitor -n {}",
    "電源を確認して下さい。再起動の有無の確認: blactl monitor -n {}"};
inline constexpr Text motion_not_repeated{
    "node {}: no command went out for {} ms: the servo's own timeout has acted meanwhile",
    "ノード {}: {} ms の間、指令を送信できず、その間にサーボの通信タイムアウトが動作しました"};
inline constexpr Text motion_not_repeated_hint{
    "this computer or its bus is too busy: end other programs, then run the command again",
    "PC またはバスの負荷が高すぎます。他のプログラムを終了してから再度実行して下さい"};
inline constexpr Text motion_not_taken{"node {}: {} does not take {}: {}",
                                       "ノード {}: {} に {} が反映されません ({})"};
inline constexpr Text motion_holds{"it holds {}", "現在値 {}"};
inline constexpr Text motion_no_value{"its answer holds no value", "応答に値がありません"};
inline constexpr Text motion_not_ended{"{1}; whether node {0} was brought to its end is not known",
                                       "{1}。ノード {0} の動作を終了できたか確認できません"};
inline constexpr Text motion_nor_ended{"{}; and {}", "{}。さらに、{}"};
inline constexpr Text motion_not_ended_hint{"{}; to stop it: blactl set -n {} torque_output=off",
                                            "{}。停止するには: blactl set -n {} torque_output=off"};
inline constexpr Text motion_newcomer{
    "node {} appeared, restarted or reported servo ID {} while that was commanded by ArrayCommand: "
    "it may "
    "have moved as well",
    "ArrayCommand でサーボ ID {1} に指令中に、ノード {0} の出現、再起動、"
    "またはサーボ ID の変更がありました。このノードも動作した可能性があります"};
inline constexpr Text motion_not_reached{"node {}: it was to be at {}, and is held at {}",
                                         "ノード {}: 指令角度 {} に到達せず、{} で保持しています"};
inline constexpr Text motion_not_turned{
    "node {}: it was commanded {}, and did not come to half of that",
    "ノード {}: {} を指令しましたが、その半分の速度に達しませんでした"};
inline constexpr Text motion_not_seen{
    "node {}: what it did was not seen: its time was too short, or its answers came too late",
    "ノード {}: 指令時間が短いか、応答が遅いため、動作を確認できませんでした"};
inline constexpr Text motion_not_seen_standing{
    "node {}: too few answers came to see whether it stands",
    "ノード {}: 応答が少なく、停止を確認できませんでした"};
inline constexpr Text motion_still_moves{
    "node {}: it was told to stop, and its shaft still moves (it was at {})",
    "ノード {}: 停止を指令しましたが、出力軸がまだ動いています (現在角度 {})"};
inline constexpr Text motion_not_holding{"node {}: {} is {} now: nothing holds the shaft",
                                         "ノード {}: {} が {} のため、出力軸は保持されていません"};
inline constexpr Text motion_protected{
    "node {}: {}: this holds its output off, and what was commanded has no effect",
    "ノード {}: {} のため出力が OFF になっており、指令は効いていません"};
inline constexpr Text motion_not_holding_hint{"to hold it where it is: blactl set {}=on -n {}",
                                              "現在位置で保持するには: blactl set {}=on -n {}"};
inline constexpr Text motion_cut_hint{"{}; to stop it: cut its supply",
                                      "{}。停止するには電源を切って下さい"};
inline constexpr Text motion_not_wiggled{"node {}: it was commanded to and fro, and did not move",
                                         "ノード {}: 往復動作を指令しましたが、動きませんでした"};
inline constexpr Text motion_array_ignored{
    "node {}: {} was sent by ArrayCommand, and nothing shows that it took it",
    "ノード {}: ArrayCommand で {} を送信しましたが、反映を確認できません"};
inline constexpr Text motion_servo_id_0_hint{
    "servo ID 0 may not be obeyed: give it another (blactl set -n {} servo_id=1 --save), or leave "
    "--array out",
    "サーボ ID 0 への ArrayCommand は無効な可能性があります。別の ID を設定する (blactl set -n {} "
    "servo_id=1 --save) か、--array を外して下さい"};
inline constexpr Text motion_not_held{"node {}: it was told to hold {}, and is at {}",
                                      "ノード {}: {} での保持を指令しましたが、現在角度は {} です"};
inline constexpr Text motion_still_turns{
    "node {}: it was told to stop, and still turns at {}",
    "ノード {}: 停止を指令しましたが、まだ {} で回転しています"};
inline constexpr Text motion_why_hint{
    "too little time, a load, or a fault? blactl faults -n {}",
    "時間不足、負荷、または異常の可能性があります。異常の確認: blactl faults -n {}"};

} // namespace blactl::texts
