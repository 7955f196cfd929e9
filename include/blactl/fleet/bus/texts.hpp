#pragma once
// Messages about responses, reading and writing, and others without their own catalogue.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text no_answer{"node {}: no answer to {}", "ノード {}: {} に応答がありません"};
inline constexpr Text no_answer_hint{
    "check supply and cable, or ask more patiently with --timeout and --retries",
    "電源と配線を確認するか、--timeout と --retries で待ち時間を延ばして下さい",
};
inline constexpr Text not_sent{"node {}: the request for {} did not leave this machine",
                               "ノード {}: {} の要求を送信できませんでした"};
inline constexpr Text cancelled{"node {}: {} was not finished", "ノード {}: {} は完了していません"};
inline constexpr Text not_recorded{"node {}: not in the recording: {}",
                                   "ノード {}: 記録にありません: {}"};
inline constexpr Text not_recorded_hint{
    "only what was asked is recorded, and counts until a restart or a change; for all of it: "
    "blactl get --all --record FILE",
    "記録されるのは要求した値のみで、再起動や設定変更の後は無効です。すべて記録するには: "
    "blactl get --all --record FILE"};
inline constexpr Text identity_not_recorded{
    "node {} is in the recording, but not what it is",
    "ノード {} は記録にありますが、機種などの情報がありません"};
inline constexpr Text node_not_recorded{"node {} is not in the recording",
                                        "ノード {} は記録にありません"};
inline constexpr Text register_refused{"node {}: the servo refuses {}",
                                       "ノード {}: サーボが {} を拒否しました"};
inline constexpr Text register_refused_hint{
    "the firmware of this servo may lack this parameter: blactl get firmware_version -n {}",
    "このサーボのファームウェアには無いパラメータかもしれません: blactl get firmware_version -n {}",
};
inline constexpr Text no_register_value{
    "node {}: the answer of the servo for {} is not a value of that register",
    "ノード {}: {} の応答がこのレジスタの値ではありません"};
inline constexpr Text nobody_acknowledges{
    "{}: nobody acknowledges our frames",
    "{}: 送信フレームに対する ACK がありません",
};
inline constexpr Text nobody_acknowledges_hint{
    "is a servo powered and connected, the bus terminated, and the bit rate 1000000?",
    "サーボの電源と接続、終端抵抗、ビットレート 1000000 を確認して下さい",
};
inline constexpr Text bus_is_off{"{}: the controller is bus-off",
                                 "{}: コントローラがバスオフ状態です"};
inline constexpr Text interrupted{"ended by {}", "{} により中断されました"};
inline constexpr Text unreadable_frames{
    "messages passed over that were no frames of classic CAN (CAN FD, or damaged): {}",
    "Classic CAN フレームではないメッセージ {} 件を無視しました (CAN FD または破損)"};
inline constexpr Text frames_lost{
    "frames lost because they came faster than they could be read: {}",
    "読出しが間に合わず {} フレームを失いました",
};
inline constexpr Text node_mute{"node {} is on the bus but does not answer",
                                "ノード {} はバス上にありますが応答しません"};
inline constexpr Text written_to_another{
    "node {} became another servo while it was written to: which of them took the values is not "
    "known",
    "ノード {} は書込み中に別のサーボに替わりました。どちらに書き込まれたかは不明です",
};
inline constexpr Text written_too_late{
    "node {} has only just started, and answers too late to tell whether it restarted while it was "
    "written to: it may not hold the values",
    "ノード {} "
    "は起動直後で応答が遅いため、書込み中に再起動したか判定できません。値を保持していない可能性が"
    "あります",
};
inline constexpr Text about_node{"node {}: {}", "ノード {}: {}"};
inline constexpr Text about_nodes{"nodes {}: {}", "ノード {}: {}"};
inline constexpr Text write_refused{"node {}: {}={}: the servo did not take it and still holds {}",
                                    "ノード {}: {}={}: サーボが受け付けません。値は {} のままです"};
inline constexpr Text write_mismatch{"node {}: {}={}: the servo holds {} instead",
                                     "ノード {}: {}={}: サーボの値は {} になっています"};
inline constexpr Text not_taken_hint{
    "is it the model that it says it is? compare its label with: blactl get -n {} --group product",
    "機種が正しいか銘板と照合して下さい: blactl get -n {} --group product"};
inline constexpr Text restarted_while_read{
    "node {} restarted while it was read: what was in its RAM only is lost, nothing was saved",
    "ノード {} は読出し中に再起動しました。RAM のみの変更は失われ、保存していません",
};
inline constexpr Text answers_too_late{
    "node {} has only just started, and answers too late to tell whether it restarted while it was "
    "read",
    "ノード {} は起動直後で応答が遅いため、読出し中に再起動したか判定できません",
};
inline constexpr Text restarts_while_read{
    "node {} restarts again and again while it is read",
    "ノード {} は読出し中に何度も再起動しています",
};
inline constexpr Text restarts_again_hint{
    "check its supply voltage",
    "電源電圧を確認して下さい",
};
inline constexpr Text rom_unreadable{
    "node {} could not read its ROM at its start and holds initial values",
    "ノード {}: 起動時に ROM のデータを読み出せず、初期値で動作しています"};
inline constexpr Text rom_unreadable_hint{
    "the next start may read it: blactl restart -n {}; was the supply cut while it saved?",
    "再起動で読み出せる場合があります: blactl restart -n {} (保存中の電源断の可能性あり)"};
inline constexpr Text read_twice{
    "nodes {} and {} were one servo, which changed its node ID meanwhile",
    "ノード {} と {} は同一サーボです (途中でノード ID が変わりました)"};
inline constexpr Text another_servo{"node {} is another servo now",
                                    "ノード {} は別のサーボに替わりました"};
inline constexpr Text opcode_refused_hint{
    "a fault may be the reason: blactl get -n {} --group fault",
    "原因を異常情報で確認して下さい: blactl get -n {} --group fault"};
inline constexpr Text not_proven_any_more{
    "node {} was written to, but does not answer any more: whether it still holds the values is "
    "not known",
    "ノード {} は書込み後に応答しなくなりました。値を保持しているか不明です",
};
inline constexpr Text write_lost{"node {}: {}={}: no answer, and the servo still holds {}",
                                 "ノード {}: {}={}: 応答がなく、値は {} のままです"};
inline constexpr Text other_writer{
    "node {1} wrote to node {0} meanwhile: it does not hold what was wanted",
    "ノード {1} がノード {0} に書き込んだため、設定した値になっていません"};
inline constexpr Text written_by_other{
    "node {1} wrote to node {0} meanwhile: what it holds now is not known",
    "ノード {1} がノード {0} に書き込んだため、現在の値は不明です"};
inline constexpr Text written_while_read{
    "node {1} writes to node {0} again and again while it is read",
    "ノード {0} の読出し中に、ノード {1} が繰り返し書き込んでいます"};
inline constexpr Text faults_flicker{"node {}: its faults come and go while they are read",
                                     "ノード {}: 読出し中に異常の発生と解消を繰り返しています"};
inline constexpr Text faults_not_recorded{
    "node {}: what it reports of faults is not what the registers in the recording show",
    "ノード {}: 通知された状態と、記録されたレジスタの異常が一致していません"};
inline constexpr Text faults_not_recorded_hint{"record them: blactl faults --record FILE",
                                               "記録するには: blactl faults --record FILE"};
inline constexpr Text other_writer_hint{"stop it, then run the command again",
                                        "停止させてから再度実行して下さい"};
inline constexpr Text not_read_completely{
    "node {} was not read completely: none of its values is shown",
    "ノード {} の読出しは途中で終了したため、表示しません"};
inline constexpr Text warn_not_asked{"has restarted, and has not said since who it is",
                                     "再起動後、どのユニットか不明です"};
inline constexpr Text warn_gone{"does not answer any more", "応答しなくなりました"};
inline constexpr Text warn_unanswered{"did not answer when it was asked last",
                                      "直前の問合せに応答がありませんでした"};
inline constexpr Text warn_offline{"has not been heard for {} s", "{} 秒間受信していません"};
inline constexpr Text what_it_holds_hint{
    "the same command goes on from here; what it holds: blactl get -n uid:{} --changed",
    "同じコマンドで続きから実行できます。内容を確認: blactl get -n uid:{} --changed"};
inline constexpr Text command_is_not_saved{"{} is a command: SAVE does not keep it",
                                           "{} は動作指令であり、SAVE では保存されません"};
inline constexpr Text command_is_not_saved_hint{"leave --save out, or the command",
                                                "--save か指令のどちらかを外して下さい"};
inline constexpr Text judged_change{"{}={}: {}", "{}={}: {}"};
inline constexpr Text set_first_hint{"first: blactl set -n {} {}",
                                     "先に実行して下さい: blactl set -n {} {}"};
inline constexpr Text holds_instead{"{} is {} instead of {}", "{} は {} (期待値 {})"};
inline constexpr Text not_begun{"node {}: interrupted before anything was sent",
                                "ノード {}: 送信前に中断されました"};
inline constexpr Text unchanged_no_more{
    "node {} restarted: {} may have another value now",
    "ノード {} が再起動したため、{} の値が変わっている可能性があります",
};
inline constexpr Text lost_since{
    "node {} has restarted since: what was in RAM only, and nobody has saved, is lost",
    "ノード {} がその後再起動したため、保存されていない RAM の変更は失われました",
};
inline constexpr Text unproven_since{
    "node {} has restarted since its ROM was proven: what its ROM holds now is not known",
    "ノード {} は ROM の確認後に再起動しました。現在の ROM の内容は不明です",
};
inline constexpr Text restarted_before_write{
    "node {} restarted after it was read: nothing was written",
    "ノード {} が読出し後に再起動したため、書き込んでいません",
};
inline constexpr Text run_again_hint{"run the command again",
                                     "同じコマンドをもう一度実行して下さい"};
inline constexpr Text lost_while_listening{
    "frames were lost while listening: who drives or is armed is not known",
    "受信中にフレームを失ったため、動作指令や ARM 状態を確認できません",
};
inline constexpr Text not_written{"the queue of {1} may still hold frames of a write ({0}): "
                                  "what they change is not known",
                                  "書込みの {} フレームが {} の送信キューに残っている可能性があり、"
                                  "変更結果は不明です"};
inline constexpr Text question_may_move{
    "This can move the shaft or let go of the load:\n",
    "出力軸が動く、または負荷を保持できなくなる可能性があります:\n"};
inline constexpr Text question_change{"  node {}: {} {} -> {}\n", "  ノード {}: {} {} -> {}\n"};
inline constexpr Text question_reason{"    ({})\n", "    ({})\n"};
inline constexpr Text unknown_before{"?", "?"};
inline constexpr Text warn_stall{
    "firmware {} may stall at low speed; 1.400 fixes it",
    "ファームウェア {} は低速動作時にストールすることがあります (1.400 で修正)",
};
inline constexpr Text warn_unknown_model{"no profile fits: it can only be read",
                                         "該当するプロファイルが無いため読出しのみ可能です"};
inline constexpr Text warn_uncertain_model{
    "hardware version {} is not in table 3-12: model by its leading digits only",
    "ハードウェアバージョン {} は表 3-12 にありません。機種は先頭の桁のみで判定しました",
};
inline constexpr Text warn_static_id_differs{
    "0x46 in RAM is {}: once it is saved, that is its node ID after a restart",
    "RAM の 0x46 は {} です。ROM に保存されていれば再起動後のノード ID になります"};
inline constexpr Text warn_health{"health: {} (see 0x1A, 0x1B)",
                                  "健康状態: {} (0x1A, 0x1B を参照)"};
// NodeStatus
inline constexpr Text health_ok{"ok", "正常"};
inline constexpr Text health_warning{"warning", "警告"};
inline constexpr Text health_error{"error", "障害"};
inline constexpr Text health_critical{"critical", "重大な障害"};
inline constexpr Text mode_operational{"operational", "動作中"};
inline constexpr Text mode_initialization{"initialization", "初期化中"};
inline constexpr Text mode_maintenance{"maintenance", "保守中"};
inline constexpr Text mode_software_update{"software update", "ソフトウェア更新中"};
inline constexpr Text mode_offline{"offline", "オフライン"};

inline constexpr Text only_readable{"the model is not known: it can only be read",
                                    "機種が不明のため読出しのみ可能です"};
inline constexpr Text bootloader_unread{"bootloader (0x49) is neither read nor written",
                                        "bootloader (0x49) は読み書きできません"};
inline constexpr Text bootloader_unread_hint{"the specification forbids it (section 4.39)",
                                             "仕様書 4.39 により書込み禁止です"};
inline constexpr Text write_only{"{} can only be written", "{} は書込み専用です"};
inline constexpr Text write_only_hint{"it is an operation, not a value; to carry it out: blactl {}",
                                      "値ではなく操作です。実行するには: blactl {}"};
inline constexpr Text firmware_lacks{"{} needs firmware {} or later, this servo has {}",
                                     "{} にはファームウェア {} 以降が必要です (現在 {})"};
inline constexpr Text firmware_lacks_hint{"read what it has: blactl get -n {}",
                                          "読み出せるパラメータ: blactl get -n {}"};
inline constexpr Text and_more{"{} and {} more", "{} 他 {} 件"};
inline constexpr Text unknown_group{"there is no group '{}'", "グループ '{}' はありません"};
inline constexpr Text or_a_group{" (all of a group: --group {})", " (グループ全体: --group {})"};
inline constexpr Text known_groups{"the groups are {}", "グループ: {}"};

inline constexpr Text no_command_with_number{"no command with the number {} is recorded",
                                             "番号 {} のコマンドは変更履歴にありません"};
inline constexpr Text no_command_with_number_hint{"what is recorded: blactl undo --list",
                                                  "変更履歴の表示: blactl undo --list"};
inline constexpr Text too_many_changes_since{
    "uid:{1} was changed a hundred times since command {0}: what it held before is not recorded",
    "uid:{1} はコマンド {0} 以降に 100 回変更されており、それ以前の値は記録されていません"};
inline constexpr Text no_setting_in_history{
    "the change history says that {} was replaced, which is not a setting",
    "変更履歴にある {} は設定項目ではありません"};
inline constexpr Text no_setting_in_history_hint{
    "if it is one of a profile, name its folder with --profile-dir; else another program has "
    "written to snapshots.db: move it away, a new one is begun",
    "プロファイルの設定項目なら --profile-dir を指定して下さい。それ以外では snapshots.db が別の"
    "プログラムで書き換えられています (移動すると新しく作成されます)"};

} // namespace blactl::texts
