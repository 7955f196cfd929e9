#pragma once
// The catalogue of the floor fleet.

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
    "node {}: what the servo answers for {} is no value of that register",
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

inline constexpr Text node_not_found{"node {} is not on the bus", "ノード {} はバス上にありません"};
inline constexpr Text node_not_found_hint{"see who is there: blactl scan",
                                          "接続中のノードを確認: blactl scan"};
inline constexpr Text node_mute{"node {} is on the bus but does not answer",
                                "ノード {} はバス上にありますが応答しません"};
inline constexpr Text not_a_servo{"node {} ({}) is not a BLA servo",
                                  "ノード {} ({}) は BLA サーボではありません"};
inline constexpr Text no_servo_found{"no BLA servo is on the bus",
                                     "バス上に BLA サーボがありません"};
inline constexpr Text no_servo_found_hint{
    "a servo without a node ID shows in: blactl scan",
    "ノード ID の無いサーボは blactl scan で確認できます",
};
inline constexpr Text no_node_is_servo{
    "nodes on the bus: {}; none is known to be a BLA servo",
    "バス上のノード ({}) に BLA サーボと判別できるものがありません"};
inline constexpr Text no_node_is_servo_hint{
    "name one by its ID, for example -n {}, or see what they are: blactl scan",
    "-n {} のように ID を指定するか、ノードの種類を確認して下さい: blactl scan"};
inline constexpr Text nothing_matches{"no servo on the bus matches {}",
                                      "{} に該当するサーボはバス上にありません"};
inline constexpr Text target_waits_for_id{
    "{} waits for a node ID: it cannot be asked before it has one",
    "{} はノード ID の割当て待ちです。割当て前は問い合わせできません"};
inline constexpr Text target_waits_for_id_hint{
    "give it a node ID: blactl alloc --once (or let the flight controller do it)",
    "ノード ID を割り当てて下さい: blactl alloc --once (フライトコントローラでも可)"};
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
inline constexpr Text restarts_again{
    "node {} restarts again and again while it is written to",
    "ノード {} は書込み中に何度も再起動しています",
};
inline constexpr Text restarts_again_hint{
    "check its supply voltage",
    "電源電圧を確認して下さい",
};
inline constexpr Text about_node{"node {}: {}", "ノード {}: {}"};
inline constexpr Text write_refused{"node {}: {}={}: the servo did not take it and still holds {}",
                                    "ノード {}: {}={}: サーボが受け付けません。値は {} のままです"};
inline constexpr Text write_mismatch{"node {}: {}={}: the servo holds {} instead",
                                     "ノード {}: {}={}: サーボの値は {} になっています"};

inline constexpr Text not_taken_hint{
    "is it the model that it says it is? compare its label with: blactl get -n {} --group product",
    "機種が正しいか銘板と照合して下さい: blactl get -n {} --group product"};

inline constexpr Text doubled_static_id{"nodes {} have the same static node ID {}",
                                        "ノード {} の UAVCAN ノード ID 設定が {} で重複しています"};
inline constexpr Text doubled_servo_id{"nodes {} have the same servo ID {}",
                                       "ノード {} のサーボ ID が {} で重複しています"};

inline constexpr Text doubled_target{"two units use node ID {}",
                                     "ノード ID {} を 2 台が使用しています"};
inline constexpr Text doubled_units{"two units use node ID {}: {}",
                                    "ノード ID {} を 2 台が使用しています: {}"};
inline constexpr Text foreign_actuator{
    "node {} ({}) sends actuator.Status but answers no GetSet: it is not taken for a BLA servo",
    "ノード {} ({}) は actuator.Status を送信しますが GetSet に応答しないため、BLA "
    "サーボとして扱いません",
};
inline constexpr Text node_gone{"node {} does not answer any more",
                                "ノード {} が応答しなくなりました"};
inline constexpr Text restarted_while_read{
    "node {} restarted while it was read: what was in its RAM only is lost, nothing was saved",
    "ノード {} は読出し中に再起動しました。RAM のみの変更は失われ、保存していません",
};
inline constexpr Text answers_too_late{
    "node {} has only just started, and answers too late to tell whether it restarted while it was "
    "read",
    "ノード {} は起動直後で応答が遅いため、読出し中に再起動したか判定できません",
};
inline constexpr Text saved_too_late{
    "node {} answers too late to tell whether it restarted before SAVE: nothing was saved",
    "ノード {} の応答が遅く、SAVE の前に再起動したか判定できないため、保存していません",
};
inline constexpr Text restarts_while_read{
    "node {} restarts again and again while it is read",
    "ノード {} は読出し中に何度も再起動しています",
};
inline constexpr Text not_proven_any_more{
    "node {} was written to, but does not answer any more: whether it still holds the values is "
    "not known",
    "ノード {} は書込み後に応答しなくなりました。値を保持しているか不明です",
};
inline constexpr Text write_lost{"node {}: {}={}: no answer, and the servo still holds {}",
                                 "ノード {}: {}={}: 応答がなく、値は {} のままです"};
inline constexpr Text restarted_before_save{
    "node {} restarted before SAVE: its RAM no longer holds what was to be saved, nothing was "
    "saved",
    "ノード {} は SAVE の前に再起動し、保存するはずの値が RAM から失われたため、保存していません",
};
inline constexpr Text changed_before_save{
    "node {} no longer holds in RAM what was to be saved (it restarted, or another node wrote to "
    "it): nothing was saved",
    "ノード {} の RAM の値が保存するはずの値と異なります (再起動または別ノードによる書込み)。"
    "保存していません",
};
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
    "node {}: it tells of faults which the registers in the recording do not show",
    "ノード {}: 異常が通知されていますが、記録されたレジスタの値に現れていません"};
inline constexpr Text faults_not_recorded_hint{"record them: blactl faults --record FILE",
                                               "記録するには: blactl faults --record FILE"};
inline constexpr Text other_writer_hint{"stop it, then run the command again",
                                        "停止させてから再度実行して下さい"};
inline constexpr Text not_read_completely{
    "node {} was not read completely: none of its values is shown",
    "ノード {} の読出しは途中で終了したため、表示しません"};
inline constexpr Text not_there_yet{"node {} was not there yet when the wait ended",
                                    "ノード {} は待機終了時点で動作していません"};
inline constexpr Text warn_gone{"does not answer any more", "応答しなくなりました"};
inline constexpr Text warn_unanswered{"did not answer when it was asked last",
                                      "直前の問合せに応答がありませんでした"};
inline constexpr Text warn_offline{"has not been heard for {} s", "{} 秒間受信していません"};
inline constexpr Text id_given_is_taken{
    "node {} would get node ID {}, which another unit has (uid:{})",
    "ノード {} に設定されるノード ID {} は別の機器 (uid:{}) が使用しています",
};
inline constexpr Text id_given_will_be_taken{
    "node {} would get node ID {}, which node {} has, or gets once it is saved and restarts",
    "ノード {} に設定されるノード ID {} は、ノード {} の (または保存・再起動後の) ID と重複します",
};
inline constexpr Text servo_id_given_is_taken{
    "node {} would have servo ID {}, which node {} has",
    "ノード {} のサーボ ID {} はノード {} と重複します",
};
inline constexpr Text servo_id_taken_hint{"see who has which: blactl get -n all servo_id",
                                          "各サーボの ID を確認: blactl get -n all servo_id"};
inline constexpr Text servo_id_for_several{
    "one servo ID for {} servos: a command for one would move all of them",
    "{} 台に同じサーボ ID を設定すると、一つの指令で全てが動きます",
};
inline constexpr Text saved_not_verified{
    "node {} was sent SAVE and is back, but its values were not read again",
    "ノード {} は SAVE 後に復帰しましたが、値を再確認していません",
};
inline constexpr Text erased_not_verified{
    "node {}: ERASE was sent, and its values were not read again: what its RAM holds is not known",
    "ノード {}: ERASE を送信しましたが、値を再確認していません。RAM の内容は不明です",
};
inline constexpr Text erased_not_saved{
    "node {}: its RAM holds factory defaults, its ROM was not written: a SAVE would keep them",
    "ノード {}: RAM は初期値です。ROM には保存していません (SAVE すると初期値が保存されます)",
};
inline constexpr Text what_it_holds_hint{"see what it holds: blactl get -n uid:{} --changed",
                                         "内容を確認: blactl get -n uid:{} --changed"};
inline constexpr Text command_is_not_saved{"{} is a command: SAVE does not keep it",
                                           "{} は動作指令であり、SAVE では保存されません"};
inline constexpr Text command_is_not_saved_hint{"leave --save out, or the command",
                                                "--save か指令のどちらかを外して下さい"};
inline constexpr Text judged_change{"{}={}: {}", "{}={}: {}"};
inline constexpr Text set_first_hint{"first: blactl set -n {} {}",
                                     "先に実行して下さい: blactl set -n {} {}"};
inline constexpr Text question_restart_unknown{
    "node {}: it starts with what its ROM holds, which is not known: torque may come on, and the "
    "shaft may run to 0 deg\n",
    "ノード {}: ROM の内容 (不明) で起動します。トルクが ON になり、出力軸が 0° "
    "へ動く可能性があります\n",
};
inline constexpr Text question_erase_torque{"node {}: torque comes on\n",
                                            "ノード {}: トルクが ON になります\n"};
inline constexpr Text question_erase_rom{
    "ROM is not touched: a restart brings back what was saved\n",
    "ROM は変更しません。再起動すると保存済みの値に戻ります\n",
};
inline constexpr Text doubled_meanwhile_hint{
    "one of them, or both, may have taken what was sent: connect one of them alone, give it "
    "another "
    "ID, and look at both",
    "送信した内容は一方または両方に反映された可能性があります。1 台だけ接続して ID "
    "を変更し、両方の設定を確認して下さい",
};
inline constexpr Text doubled_target_hint{"connect one of them alone and give it another ID",
                                          "1 台ずつ接続して別の ID を設定して下さい"};
inline constexpr Text armed{"node {} says that the vehicle is armed: nothing is written",
                            "ノード {} が ARM 状態を通知しているため書き込みません"};
inline constexpr Text armed_hint{"disarm it first", "先に DISARM して下さい"};
inline constexpr Text driven{"node {} commands node {}: not while it does",
                             "ノード {} がノード {} に動作指令を送信中のため実行しません"};
inline constexpr Text driven_hint{"stop it, or add --while-driven",
                                  "停止させるか、--while-driven を付けて下さい"};
inline constexpr Text node_id_is_ours_hint{
    "run the command with another node ID of its own: --local-node-id ID",
    "自ノードに別の ID を指定して下さい: --local-node-id ID"};
inline constexpr Text node_id_in_use_hint{"see which IDs are taken: blactl scan",
                                          "使用中の ID を確認: blactl scan"};

inline constexpr Text defaults_unknown_hint{
    "see what it says of itself: blactl get --group product",
    "機種情報を確認: blactl get --group product",
};
inline constexpr Text holds_instead{"{} is {} instead of {}", "{} は {} (期待値 {})"};
inline constexpr Text rom_unreadable{
    "node {} could not read its ROM at its start and holds initial values",
    "ノード {}: 起動時に ROM のデータを読み出せず、初期値で動作しています"};
inline constexpr Text rom_unreadable_hint{
    "was the supply cut while it saved? write its values again, then: blactl save -n {}",
    "保存中に電源が切れた可能性があります。値を書き直してから blactl save -n {} "
    "を実行して下さい"};
inline constexpr Text not_saved{"node {}: ROM was not written",
                                "ノード {}: ROM に保存していません"};
inline constexpr Text not_begun{"node {}: interrupted before anything was sent",
                                "ノード {}: 送信前に中断されました"};
inline constexpr Text another_servo{"node {} is another servo now",
                                    "ノード {} は別のサーボに替わりました"};
inline constexpr Text restarted_before_erase{"node {} restarted: nothing more was sent to it",
                                             "ノード {} が再起動したため、以後は送信していません"};
inline constexpr Text opcode_refused{"node {} refused {}", "ノード {} が {} を拒否しました"};
inline constexpr Text opcode_ignored{
    "node {} neither answered {} nor carried it out, although it lives",
    "ノード {} は動作していますが、{} に応答せず実行もしませんでした",
};
inline constexpr Text did_not_restart{"node {} confirmed {} and then did not restart",
                                      "ノード {} は {} に応答しましたが再起動しませんでした"};
inline constexpr Text opcode_refused_hint{
    "does it tell why? blactl get -n {} --group fault",
    "原因を異常情報で確認して下さい: blactl get -n {} --group fault"};
inline constexpr Text restart_not_waited_for{
    "node {} was sent RestartNode, and was not waited for until it was back",
    "ノード {}: RestartNode 送信後、復帰を確認せずに終了しました"};
inline constexpr Text save_not_waited_for{
    "node {} was sent SAVE and was not waited for: what its ROM holds is not known",
    "ノード {}: SAVE 送信後、復帰を確認せずに終了しました。ROM の内容は不明です"};
inline constexpr Text not_waited_for_hint{"is it back? blactl wait -n uid:{}",
                                          "復帰の確認: blactl wait -n uid:{}"};
inline constexpr Text rom_differs_hint{
    "RAM changed between the last reading and SAVE, or ROM did not take what RAM held: write and "
    "save again; if it stays like this, the ROM may be faulty",
    "最後の読出しから SAVE までの間に RAM の値が変わったか、ROM に保存されていません。"
    "書込みと保存を再度行い、改善しなければ ROM の異常の可能性があります"};
inline constexpr Text saved_not_back{
    "node {} confirmed SAVE and did not come back: what its ROM holds is not known",
    "ノード {} は SAVE に応答後、復帰しません。ROM の内容は不明です",
};
inline constexpr Text back_not_operational{
    "node {} has restarted and answers, but is not operational yet",
    "ノード {} は再起動後に応答していますが、まだ動作状態ではありません"};
inline constexpr Text heard_not_answering{
    "node {} is heard, but does not answer any more: whether it carried out {} is not known",
    "ノード {} は受信できていますが応答しません。{} が実行されたかどうかは不明です"};
inline constexpr Text restarted_not_back{"node {} confirmed the restart and did not come back",
                                         "ノード {} は再起動に応答後、復帰しません"};
inline constexpr Text unconfirmed_not_back{
    "node {} did not answer {} and is gone: whether it was carried out is not known",
    "ノード {} は {} に応答せず、通信も途絶えました。実行されたかどうかは不明です",
};
inline constexpr Text not_back_hint{
    "it was given {} s (--wait SEC gives it more); check its supply and cable, power it off and "
    "on, "
    "then: blactl wait -n uid:{}",
    "{} 秒待ちました (--wait SEC で延長できます)。電源と配線を確認し、電源を入れ直してから "
    "blactl wait -n uid:{} を実行して下さい",
};
inline constexpr Text waits_for_id_hint{
    "it asks for a node ID and nobody gives it one: start the allocator of this bus again, or "
    "type: blactl alloc --once",
    "ノード ID の割当てを要求していますが、割り当てるノードがありません。割当て元を再開するか、"
    "blactl alloc --once を実行して下さい",
};
inline constexpr Text former_id_in_use_hint{
    "it asks for a node ID, and its node ID {} is used by {} now; give it another: "
    "blactl alloc --once --assign {}=ID",
    "ノード ID の割当てを要求していますが、元のノード ID {} は {} が使用中です。別の ID を指定: "
    "blactl alloc --once --assign {}=ID",
};
inline constexpr Text former_id_not_taken_hint{
    "it asks for a node ID, and node ID {} was given to it again and again, which it does not "
    "take: power it off and on, then: blactl alloc --once",
    "ノード ID の割当てを要求しています。ノード ID {} を繰り返し割り当てましたが反映されません。"
    "電源を入れ直してから blactl alloc --once を実行して下さい",
};
inline constexpr Text static_id_lost_hint{
    "it asks for a node ID, so its ROM does not hold static node ID {}, which was saved; give it "
    "one: blactl alloc --once; then see what its ROM holds: blactl get -n uid:{}",
    "ノード ID の割当てを要求しているため、保存した固定ノード ID {} は ROM にありません。"
    "blactl alloc --once で割り当ててから ROM の内容を確認: blactl get -n uid:{}",
};
inline constexpr Text unchanged_no_more{
    "node {} restarted: {} may have another value now",
    "ノード {} が再起動したため、{} の値が変わっている可能性があります",
};
inline constexpr Text lost_since{
    "node {} has restarted since: what was in RAM only, and nobody has saved, is lost",
    "ノード {} がその後再起動したため、保存されていない RAM の変更は失われました",
};
inline constexpr Text erased_no_more{
    "node {} restarted: what ERASE had reset may be back",
    "ノード {} が再起動したため、初期値に戻した設定が元に戻っている可能性があります",
};
inline constexpr Text restarted_before_write{
    "node {} restarted after it was read: nothing was written",
    "ノード {} が読出し後に再起動したため、書き込んでいません",
};
inline constexpr Text run_again_hint{"run the command again",
                                     "同じコマンドをもう一度実行して下さい"};
inline constexpr Text node_id_is_ours{"static_node_id={} is the node ID of this process",
                                      "static_node_id={} はこのプロセスのノード ID です"};
inline constexpr Text bad_target{"-n {}: not a node ID, range or selector",
                                 "-n {}: ノード ID、範囲、セレクタのいずれでもありません"};
inline constexpr Text bad_target_hint{
    "for example -n 12, -n 10-14,20, -n all, -n serial:240900558, -n model:BLA21-12U",
    "例: -n 12、-n 10-14,20、-n all、-n serial:240900558、-n model:BLA21-12U",
};

inline constexpr Text bad_target_id{"-n {}: node IDs are 1 to 127",
                                    "-n {}: ノード ID は 1～127 です"};
inline constexpr Text bad_target_id_hint{"see who is there: blactl scan",
                                         "接続中のノードを確認: blactl scan"};
inline constexpr Text bad_target_range{"-n {}: the range goes downwards",
                                       "-n {}: 範囲の前後が逆です"};
inline constexpr Text bad_target_range_hint{"type -n {}-{}", "-n {}-{} と入力して下さい"};
inline constexpr Text ambiguous_target{"-n {}: several servos have a unique ID that begins so: {}",
                                       "-n {}: 固有 ID が該当するサーボが複数あります: {}"};
inline constexpr Text ambiguous_target_hint{"type more of its digits",
                                            "固有 ID の桁を増やして下さい"};

inline constexpr Text several_servos{"several servos are on the bus: {}",
                                     "バス上に複数のサーボがあります: {}"};
inline constexpr Text several_servos_hint{"say which: -n {}", "-n {} のように指定して下さい"};
inline constexpr Text lost_while_listening{
    "frames were lost while listening: who drives or is armed is not known",
    "受信中にフレームを失ったため、動作指令や ARM 状態を確認できません",
};
inline constexpr Text one_id_for_several{
    "one static node ID for {} servos: they would collide after a restart",
    "{} 台のサーボに同じ固定ノード ID を設定すると再起動後に重複します",
};
inline constexpr Text one_id_for_several_hint{"give each its own: -n {}",
                                              "1 台ずつ設定して下さい: -n {}"};
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
inline constexpr Text doubled_servo_id_hint{
    "give one of them another: blactl set -n {} servo_id=ID --save",
    "一方に別の ID を設定して下さい: blactl set -n {} servo_id=ID --save"};
inline constexpr Text shared_servo_id_hint{
    "nodes {} each need another ID: blactl set -n {} servo_id=ID --save",
    "ノード {} にそれぞれ別の ID を設定して下さい: blactl set -n {} servo_id=ID --save"};
inline constexpr Text warn_stall{
    "firmware {} may stall at low speed; 1.400 mends it",
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
inline constexpr Text only_readable{"the model is not known: it can only be read",
                                    "機種が不明のため読出しのみ可能です"};
inline constexpr Text question_restart_soft{
    "node {}: torque is on: its output drops, then the shaft runs slowly to 0 deg\n",
    "ノード {}: トルク ON のため、出力が一旦 OFF になり、ソフトスタートで 0° へ動きます\n",
};
inline constexpr Text question_restart_hard{
    "node {}: torque is on: its output drops, then returns where the shaft is\n",
    "ノード {}: トルク ON のため、出力が一旦 OFF になり、その位置で再び ON になります\n",
};
inline constexpr Text question_erase{
    "node {}: everything to factory defaults, servo_id {} -> 0, static_node_id {} -> 0; "
    "commands become 0 deg\n",
    "ノード {}: 全ての設定を初期値に戻します。servo_id {} -> 0, static_node_id {} -> 0。"
    "指令値は 0° になります\n",
};
inline constexpr Text question_erase_keep{
    "node {}: everything but its IDs to factory defaults; commands become 0 deg\n",
    "ノード {}: ID 以外の設定を初期値に戻します。指令値は 0° になります\n",
};
inline constexpr Text wait_not_operational{"node {} was heard but not operational after {} s",
                                           "ノード {} は {} 秒待っても動作状態になりません"};
inline constexpr Text wait_not_heard{"node {} was not heard within {} s",
                                     "ノード {} は {} 秒以内に見つかりません"};

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

inline constexpr Text another_unit{"another unit", "別のユニット"};
inline constexpr Text allocates{"node {} allocates node IDs",
                                "ノード {} がノード ID を割り当てています"};
inline constexpr Text commands_servos{"node {} commands servos",
                                      "ノード {} がサーボに動作指令しています"};
inline constexpr Text says_armed{"node {} says armed", "ノード {} は ARM 状態です"};

} // namespace blactl::texts
