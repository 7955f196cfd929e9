#pragma once
// Messages of the characterization.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text bench_restarted{"node {}: it restarted by itself while it was measured",
                                      "ノード {}: 測定中にサーボが再起動しました"};
inline constexpr Text bench_restarted_hint{"look at its supply, then run it again",
                                           "電源を確認してからもう一度実行して下さい"};
inline constexpr Text bench_saved_by_other{
    "node {1} had the values of node {0} saved while it was measured: its ROM may hold those of "
    "the "
    "measurement",
    "測定中にノード {1} がノード {0} に保存を指示したため、ROM に測定用の値が保存された可能性が"
    "あります"};
inline constexpr Text bench_saved_by_other_hint{"to put RAM and ROM back: blactl undo -n {}",
                                                "RAM と ROM を元に戻すには: blactl undo -n {}"};
inline constexpr Text bench_not_back_and_saved{"{}; {}", "{}。{}"};
inline constexpr Text bench_changed{
    "node {}: {} is {}, not {} as a moment ago: somebody else changes it, or it restarted",
    "ノード {}: {} が先ほどと異なります ({}、直前は {})。他の機器が変更したか、再起動しています"};
inline constexpr Text bench_bystander{
    "node {}: node {} appeared, restarted or reports servo ID {}: it might obey the ArrayCommands "
    "that measure this one",
    "ノード {}: ノード {} の出現、再起動、またはサーボ ID {} の送信がありました。測定用の "
    "ArrayCommand に従う可能性があります"};
inline constexpr Text bench_bystander_hint{"measure with the servo alone on the bus",
                                           "測定するサーボだけをバスに接続して下さい"};
inline constexpr Text bench_set_refused{"node {}: {} did not take {}, it holds {}",
                                        "ノード {}: {} に {} を設定できません (現在値 {})"};
inline constexpr Text bench_left{"node {} still holds what an interrupted characterize has set: "
                                 "these settings would be measured",
                                 "ノード {} には、中断された characterize "
                                 "の設定が残っています。このままでは測定条件が変わります"};
inline constexpr Text bench_left_hint{"put it back first: blactl undo -n {}",
                                      "先に元に戻して下さい: blactl undo -n {}"};
inline constexpr Text bench_moves{
    "node {}: it is commanded {}: a restart would stop it, and nothing could give that back",
    "ノード {}: {} が指令されています。再起動で停止し、元の状態には戻せません"};
inline constexpr Text bench_moves_hint{"bring it to rest first: blactl restart -n {}",
                                       "先に停止して下さい: blactl restart -n {}"};
inline constexpr Text bench_not_put_back{"node {}: not put back: {} ({})",
                                         "ノード {}: 元に戻せませんでした: {} ({})"};
inline constexpr Text bench_not_proven{
    "node {}: whether everything is as it was is not known ({})",
    "ノード {}: 元の状態に戻ったことを確認できませんでした ({})"};
inline constexpr Text bench_put_back_hint{"to put it back: blactl set -n {} {}",
                                          "元に戻すには: blactl set -n {} {}"};
inline constexpr Text bench_restart_hint{
    "to put it back: blactl restart -n {} (what was in its RAM only is lost)",
    "元に戻すには: blactl restart -n {} (RAM のみの変更は失われます)"};
inline constexpr Text bench_angle_hint{
    "to command it again, which moves it: blactl set -n {} command_angle={}raw",
    "再度指令するには (出力軸が動きます): blactl set -n {} command_angle={}raw"};
inline constexpr Text bench_still_commanded{"{} is {}, and was not before",
                                            "{} が測定前と異なり {} です"};
inline constexpr Text bench_would_turn{"with its output on it would turn: {} is {}",
                                       "出力を ON にすると回転します: {} が {} です"};
inline constexpr Text bench_id_in_use{"node ID {} is in use by another unit",
                                      "ノード ID {} は他の機器が使用中です"};

inline constexpr Text bench_question{
    "node {}: measures this servo and leaves nothing changed:\n"
    "  - its output drops several times: nothing may hang on it, nothing may be in its way\n"
    "  - it is restarted {} times, and saves once what its ROM holds already: do not cut the "
    "supply\n"
    "  - after each start torque may come on, and the shaft may run slowly to 0 deg\n"
    "  - torque comes on for a moment more, and holds the shaft where it is\n"
    "  - timeout_time is written once out of range, and put back; so is a speed, by ArrayCommand "
    "with the output off\n",
    "ノード {}: サーボの挙動を測定し、終了時にすべて元に戻します:\n"
    "  - 出力が数回 OFF になります。負荷や障害物を取り除いて下さい\n"
    "  - {} 回再起動し、ROM の内容をそのまま 1 回保存します。電源を切らないで下さい\n"
    "  - 起動のたびにトルクが ON になり、出力軸が 0° へ低速で動く可能性があります\n"
    "  - その他にトルクが一時的に ON になり、現在位置で保持します\n"
    "  - timeout_time に範囲外の値を 1 回だけ書き込んだ後、元に戻します。出力 OFF "
    "の状態で、範囲外の"
    "速度を ArrayCommand で指令します\n"};
inline constexpr Text bench_question_angle{
    "  - in the end it is commanded {} again, and goes there at its full speed\n",
    "  - 最後に指令角度 {} を再設定するため、出力軸が全速で動く可能性があります\n"};

inline constexpr Text bench_stage_answers{"measuring how it answers", "応答を測定中"};
inline constexpr Text bench_stage_settings{"measuring with the output off", "出力 OFF で測定中"};
inline constexpr Text bench_stage_starts{"measuring how it starts", "起動を測定中"};
inline constexpr Text bench_stage_save{"measuring how it saves", "保存を測定中"};
inline constexpr Text bench_stage_put_back{"putting back what was changed", "元に戻しています"};

// Reasons for not measuring that arise on the bench only.

inline constexpr Text bench_no_answer{"it did not answer", "応答がありませんでした"};
inline constexpr Text bench_answers_lost{
    "no answer came; but answers to other questions were lost as well",
    "応答がありませんでしたが、他の質問でも応答が失われています"};
inline constexpr Text bench_odd_answer{"it answered {}, and holds {}",
                                       "応答は {}、その後の値は {} でした"};
inline constexpr Text bench_reads_differ{"reserved addresses answer differently: {}",
                                         "予約アドレスごとに応答が異なります: {}"};
inline constexpr Text bench_read_value{"it answered {}", "応答は {} でした"};
inline constexpr Text bench_nothing_gated{"this firmware lacks none of the model's registers",
                                          "このファームウェアには全レジスタがあります"};
inline constexpr Text bench_no_failure{"no failure was seen", "失敗応答がありませんでした"};
inline constexpr Text bench_no_status{"it sent no actuator.Status",
                                      "actuator.Status を受信できませんでした"};
inline constexpr Text bench_status_fields{"force {}, speed {}, power rating {}",
                                          "force {}、speed {}、power rating {}"};
inline constexpr Text bench_has_switch{"only a firmware without 0x25 shows it",
                                       "0x25 の無いファームウェアでのみ測定できます"};
inline constexpr Text bench_takes_disabled{
    "this firmware has no 0x25, and takes 0x01: it acts as if 0x25 were on, or takes what it then "
    "ignores",
    "0x25 の無いファームウェアで 0x01 が有効でした。0x25 ON "
    "相当の動作か、値を保持するだけかを区別できません"};
inline constexpr Text bench_no_switch{"this firmware has no 0x25",
                                      "このファームウェアには 0x25 がありません"};
inline constexpr Text bench_command_not_taken{"0x01 did not take the command: it holds {}",
                                              "0x01 に指令を設定できません (現在値 {})"};
inline constexpr Text bench_shaft_turns{"the shaft is turning", "出力軸が回転しています"};
inline constexpr Text bench_notice_before{"the bit was set already", "既に該当ビットが 1 でした"};
inline constexpr Text bench_no_notice{"no notice could be brought about, or there are other faults",
                                      "通知を発生させられないか、他の異常があります"};
inline constexpr Text bench_servo_id_shared{
    "ArrayCommand to servo ID {} would reach others as well",
    "サーボ ID {} への ArrayCommand は他のサーボにも届きます"};
inline constexpr Text bench_command_unseen{
    "it does not show whether ArrayCommand was taken with the output off",
    "出力 OFF で ArrayCommand が受け付けられたか判別できません"};
inline constexpr Text bench_servo_id_waits{
    "another servo ID (0x45) is not seen in actuator.Status before the next start",
    "サーボ ID (0x45) を変更しても、次の起動まで actuator.Status に現れません"};
inline constexpr Text bench_array_not_shown{"0x01 does not show what ArrayCommand brings",
                                            "ArrayCommand の指令が 0x01 に現れません"};
inline constexpr Text bench_no_notice_beyond{"a command beyond 0x38 does not set the bit either",
                                             "0x38 を超える指令でも該当ビットが 1 になりません"};
inline constexpr Text bench_shaft_turned{"the shaft was turned meanwhile",
                                         "測定中に出力軸が動きました"};
inline constexpr Text bench_acts_at_once{"at once", "直ちに有効"};
inline constexpr Text bench_acts_later{"at the next start", "次の起動から有効"};
inline constexpr Text bench_acts_unseen{"not seen", "不明"};
inline constexpr Text bench_settings_differ{"0x23: {}, 0x44: {}, 0x45: {}",
                                            "0x23: {}、0x44: {}、0x45: {}"};
inline constexpr Text bench_count_waits{
    "0x23 and 0x44 do not take effect together before the next start",
    "0x23 と 0x44 の両方が有効になるのは次の起動からです"};
inline constexpr Text bench_other_faults{"a warning or a failure is present",
                                         "警告または異常が発生しています"};
inline constexpr Text bench_pulses{"PWM pulses are present: they could move the shaft",
                                   "PWM 信号が入力されており、出力軸が動く可能性があります"};
inline constexpr Text bench_limits_out_of_reach{
    "no limit of temperature or voltage can be put to both sides of its reading",
    "温度・電圧の制限値を測定値の前後に設定できません"};
inline constexpr Text bench_reading_unsteady{
    "temperature, voltage or shaft did not stand still while the limit was at the reading",
    "制限値を測定値に合わせている間に、温度・電圧または角度が変動しました"};
inline constexpr Text bench_protection_unseen{
    "0x00 does not show that a protection has taken the output off and given it back",
    "保護による出力 OFF と復帰が 0x00 に現れません"};
inline constexpr Text bench_no_free_angle{"the angle limits leave no room",
                                          "動作角度制限が狭すぎます"};
inline constexpr Text bench_restarted_by_read{"it restarted", "再起動しました"};
inline constexpr Text bench_started_softly{"it starts softly (0x21)",
                                           "ソフトスタート (0x21) で起動します"};
inline constexpr Text bench_at_zero{"the shaft stood at 0 deg, where both look alike",
                                    "出力軸が 0° 付近のため区別できません"};
inline constexpr Text bench_no_soft_start{"it does not start softly (0x20, 0x21)",
                                          "ソフトスタートしない設定です (0x20、0x21)"};
inline constexpr Text bench_soft_start_cut{
    "a timeout (0x26, 0x27) or a fault ends its soft start at once",
    "通信タイムアウト (0x26、0x27) または異常により、ソフトスタートがすぐに終了します"};
inline constexpr Text bench_limits_alike{"its own limits are those of the soft start",
                                         "設定値がソフトスタートの制限と同じです"};
inline constexpr Text bench_asks_for_id{"it asks for a node ID first, at a random moment",
                                        "先にノード ID を要求し、その時刻は不定です"};
inline constexpr Text bench_static_id{"only a servo without a static node ID shows it",
                                      "ノード ID が動的割当てのサーボでのみ測定できます"};
inline constexpr Text bench_rom_unreadable{"its ROM cannot be read: nothing is saved over it",
                                           "ROM を読み込めないサーボのため、保存しません"};
inline constexpr Text bench_save_unproven{
    "no answer came, and it was silent no longer than in a restart: it may have restarted by "
    "itself",
    "応答がなく、無通信時間も再起動時と変わりません。自ら再起動した可能性があります"};
inline constexpr Text bench_start_unheard{"its first frames were not heard",
                                          "最初のフレームを受信できませんでした"};
inline constexpr Text bench_starts_vary{"it differs from start to start", "起動のたびに異なります"};

// Observations beside the settings.

inline constexpr Text bench_seen_name{"name of the node", "ノード名"};
inline constexpr Text bench_seen_software{"software version", "ソフトウェアバージョン"};
inline constexpr Text bench_seen_hardware{"hardware version", "ハードウェアバージョン"};
inline constexpr Text bench_seen_answers{"answers after", "応答時間"};
inline constexpr Text bench_seen_starts{"silent in a restart", "再起動時の無通信時間"};
inline constexpr Text bench_seen_save{"silent in a save", "保存時の無通信時間"};
inline constexpr Text bench_seen_allocation{"from a restart to its node ID",
                                            "再起動からノード ID 取得まで"};
inline constexpr Text bench_seen_request{"from a restart to its first request for a node ID",
                                         "再起動から最初のノード ID 要求まで"};

} // namespace blactl::texts
