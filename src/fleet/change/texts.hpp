#pragma once
// The catalogue of changes.

#include "blactl/base/text.hpp"

namespace blactl::texts {

// Messages about a change as a whole, before it.
inline constexpr Text came_since{
    "node {} has come to the bus since the servos were looked for: nothing was written",
    "サーボの検索後にノード {} がバスに加わったため、書込みを行っていません"};
inline constexpr Text did_not_tell_ids{
    "node {} gave no answer about its IDs: a conflict with it cannot be ruled out",
    "ノード {} の ID を読み出せないため、重複の有無は確認できません"};
inline constexpr Text judged_by_changed{
    "node {0}: {1} was not written, as node {2} wrote to {3} meanwhile",
    "ノード {0}: ノード {2} が {3} に書き込んだため、{1} は書き込んでいません"};
inline constexpr Text servo_id_in_unread_rom{
    "node {} could not read its ROM: a conflict with the servo ID that it holds there cannot be "
    "ruled out",
    "ノード {} は起動時に ROM を読み出せなかったため、ROM 内のサーボ ID "
    "との重複の有無は確認できません"};
inline constexpr Text id_in_unread_rom{"node {} would get node ID {}, which node {} may have in "
                                       "its ROM: it could not read that at its "
                                       "start",
                                       "ノード {} に設定されるノード ID {} は、起動時に ROM "
                                       "を読み出せなかったノード {} の ROM 内の ID "
                                       "と重複する可能性があります"};
inline constexpr Text servo_id_given_is_unread{
    "node {} would have servo ID {}, which node {} may have in its ROM: it could not read that at "
    "its start",
    "ノード {} のサーボ ID {} は、起動時に ROM を読み出せなかったノード {} の ROM 内の ID "
    "と重複する可能性があります"};
inline constexpr Text id_in_unread_rom_hint{
    "the next start may read it: blactl restart -n {0}; or take it off, or clear it: blactl erase "
    "--save -n {0}",
    "再起動で読み出せる場合があります: blactl restart -n {0}。または、取り外すか、消去して下さい: "
    "blactl erase --save -n {0}"};

// Messages about loans, which today are all of torque.
inline constexpr Text loan_not_back{"node {}: torque was not put back: {}",
                                    "ノード {}: トルクを元に戻せませんでした: {}"};
inline constexpr Text loan_back_hint{"to put it back: blactl set {}={} -n {}",
                                     "元に戻すには: blactl set {}={} -n {}"};
inline constexpr Text loan_rom_back_hint{
    "to put it back, in ROM too: blactl set {}={} -n {} --save",
    "ROM も含めて元に戻すには: blactl set {}={} -n {} --save"};
inline constexpr Text loan_saved_by_another{
    "node {}: node {} had its values saved meanwhile: its ROM holds {}={}, or may do so",
    "ノード {}: 途中でノード {} が保存を指示したため、ROM に {}={} が保存された可能性があります"};
inline constexpr Text loan_not_in_time{"interrupted", "中断されました"};
inline constexpr Text loan_changed{
    "node {}: {} is {} now, not as a moment ago: nothing was changed",
    "ノード {}: {} が直前の値から {} に変わっているため、何も変更していません"};
inline constexpr Text loan_differs{"{}, and was {} before", "{} (元の値: {})"};
inline constexpr Text loan_is{"node {}: {} is {} now", "ノード {}: {} は現在 {} です"};
inline constexpr Text loan_restarted{"node {} restarted meanwhile: {} is {} now",
                                     "ノード {} は途中で再起動しました。{} は現在 {} です"};
inline constexpr Text loan_of_another{"node {} is another servo now: its torque is left as it is",
                                      "ノード {} は別のサーボに替わったため、トルクは変更しません"};
inline constexpr Text loan_of_another_hint{"see what is there: blactl scan", "確認: blactl scan"};
inline constexpr Text loan_set_by_another{
    "node {}: node {} has written to it meanwhile: {} is {} now",
    "ノード {}: 途中でノード {} が書き込みました。{} は現在 {} です"};

// Messages about saved plans.
inline constexpr Text plan_not_finished{
    "this plan is not complete: the document reports errors; make it again",
    "計画が完成していません (エラーを含む文書です)。作り直して下さい"};
inline constexpr Text plan_no_unique_id{
    "a plan is for servos whose unique ID is known: 32 hexadecimal digits",
    "計画にはサーボの固有 ID が必要です (16 進数 32 桁)"};
inline constexpr Text plan_servo_twice{"this servo is in the plan twice, first in line {}",
                                       "このサーボは計画に 2 回あります (最初は {} 行目)"};
inline constexpr Text plan_no_setting{"a plan holds settings only: {} is not a setting",
                                      "{} は設定ではないため、計画に含められません"};
inline constexpr Text plan_other_name{"the name of {} is {}", "{} の名前は {} です"};
inline constexpr Text plan_other_unit{"it was a {} with firmware {}",
                                      "計画時は {}、ファームウェア {} でした"};
inline constexpr Text plan_set_twice{"{} is there twice", "{} が 2 回あります"};
inline constexpr Text plan_is_stale{"node {} is not as it was when the plan was made: {}",
                                    "ノード {} が計画の作成時から変わっています: {}"};
inline constexpr Text plan_is_stale_hint{"look at it, and plan again: blactl apply FILE --dry-run "
                                         "--json",
                                         "確認して計画を作り直して下さい: blactl apply FILE "
                                         "--dry-run --json"};
inline constexpr Text plan_register{"{} was {}, is {}", "{} は {} でしたが、現在は {} です"};
inline constexpr Text plan_other_settings{"a setting that the plan does not name has changed",
                                          "計画にない設定が変わっています"};
inline constexpr Text plan_rom_proven{"its ROM was proven since", "その後 ROM が確認されました"};
inline constexpr Text plan_rom_not_proven{"what its ROM holds is not known any more",
                                          "ROM の内容が不明になりました"};

// Messages about saving, erasing and restarting.
inline constexpr Text never_grows_old{
    "node {} restarts again and again: nothing was sent that saves or restarts it",
    "ノード {} が何度も再起動しているため、保存も再起動も指示していません",
};
inline constexpr Text restarts_again{
    "node {} restarts again and again while it is written to",
    "ノード {} は書込み中に何度も再起動しています",
};
inline constexpr Text premise_lost{
    "node {} restarted while it was written to: {} is {} now, and was {} when the change was "
    "checked",
    "ノード {} は書込み中に再起動しました。{} は現在 {} ですが、変更の確認時は {} でした",
};
inline constexpr Text restarted_while_written{
    "restarted while it was written to, and was written to again: any other change that was in RAM "
    "only is lost",
    "書込み中に再起動したため、再度書き込みました。他に RAM のみの変更があった場合、その変更は失わ"
    "れています",
};
inline constexpr Text unnamed_saved{
    "{} is {} in RAM and {} in ROM: SAVE keeps all of RAM, so this too",
    "{} は RAM が {}、ROM が {} です。SAVE は RAM 全体を保存するため、この値も保存されます",
};
inline constexpr Text unnamed_lost{
    "{} was {} in RAM only: the restart has brought back {}",
    "{} の {} は RAM のみの値でした。再起動により {} に戻りました",
};
inline constexpr Text recorded_saved{
    "{} is {} since a change in RAM only, and was {} before: SAVE keeps all of RAM, so this too",
    "{} は RAM のみの変更により {} です (変更前は {})。SAVE は RAM "
    "全体を保存するため、この値も保存されます",
};
inline constexpr Text recorded_at_risk{
    "{} is {} since a change in RAM only, and was {} before: the restart takes it back",
    "{} は RAM のみの変更により {} です (変更前は {})。再起動により失われます",
};
inline constexpr Text just_written_saved{
    "{} is {}, and node {} wrote to it a moment ago: SAVE keeps all of RAM, so this too",
    "{} は {} です (直前にノード {} が書き込みました)。SAVE は RAM 全体を保存するため、"
    "この値も保存されます",
};
inline constexpr Text just_written_at_risk{
    "{} is {}, and node {} wrote to it a moment ago: the restart takes back what is in RAM only",
    "{} は {} です (直前にノード {} が書き込みました)。RAM のみの値は再起動により失われます",
};
inline constexpr Text perhaps_saved{
    "{} is {} since a change that is not known to be saved, and was {} before: SAVE keeps all of "
    "RAM, so this too",
    "{} は保存されたか不明な変更により {} です (変更前は {})。SAVE は RAM 全体を保存するため、"
    "この値も保存されます",
};
inline constexpr Text perhaps_at_risk{
    "{} is {} since a change that is not known to be saved, and was {} before: the restart takes "
    "it "
    "back unless it was saved",
    "{} は保存されたか不明な変更により {} です (変更前は {})。保存されていなければ、再起動により"
    "失われます",
};
inline constexpr Text unnamed_at_risk{
    "{} is {} in RAM and {} in ROM: the restart brings that back",
    "{} は RAM が {}、ROM が {} です。再起動により ROM の値に戻ります",
};
inline constexpr Text pending_id_saved{
    "{} is {} in RAM only: SAVE keeps all of RAM, so this too, and the servo starts under that ID",
    "{} の {} は RAM のみの値です。SAVE は RAM 全体を保存するため、この値も保存され、次回はその ID "
    "で起動します",
};
inline constexpr Text pending_id_at_risk{
    "{} is {} in RAM only: the restart takes it back",
    "{} の {} は RAM のみの値です。再起動により失われます",
};
inline constexpr Text rom_unread{
    "node {} could not read its ROM at its start: saving would replace all that ROM holds by "
    "initial "
    "values",
    "ノード {} は起動時に ROM のデータを読み出せず、初期値で動作しています。保存すると ROM "
    "の内容が初期値に置き換わります"};
inline constexpr Text ids_lost_or_meant{
    "node {}: an erase --keep-ids broke off before {} was back, and the servo has restarted since: "
    "whether 0 is meant is not known",
    "ノード {}: erase --keep-ids が {} "
    "を書き戻す前に中断され、その後サーボが再起動しています。現在の値 0 が意図したものか不明です",
};
inline constexpr Text ids_lost_or_meant_hint{
    "to have it back: blactl set -n {0} {1} --save; to leave it 0: blactl erase without --keep-ids",
    "元に戻すには: blactl set -n {0} {1} --save。0 のままにするには: --keep-ids "
    "を付けずに blactl erase を実行して下さい",
};
inline constexpr Text rom_unread_hint{"the next start may read it: blactl restart -n {}",
                                      "再起動で読み出せる場合があります: blactl restart -n {}"};
inline constexpr Text question_overwrite_rom{
    "node {} could not read its ROM, not after a restart either: SAVE replaces all settings in it, "
    "limits, servo ID and node ID among them, by the initial values it runs on, for good\n",
    "ノード {} は再起動後も ROM を読み出せません。SAVE により ROM の全設定 (制限値、サーボ "
    "ID、ノード ID を含む) が現在の初期値に置き換わり、元に戻せません\n"};
inline constexpr Text overwrite_rom_hint{"add --overwrite-rom to save all the same",
                                         "それでも保存する場合は --overwrite-rom を付けて下さい"};
inline constexpr Text stopped_halfway{
    "node {} was written in RAM, in part or whole, and is not saved: {}",
    "ノード {} は RAM への書込みの途中または書込み後に中止し、保存していません: {}",
};
inline constexpr Text stopped_by_another{
    "node {} was written in RAM and is not saved: another servo failed",
    "ノード {} は RAM に書き込みましたが、別のサーボが失敗したため保存していません",
};
inline constexpr Text saved_too_late{
    "node {} answers too late to tell whether it restarted before SAVE: nothing was saved",
    "ノード {} の応答が遅く、SAVE の前に再起動したか判定できないため、保存していません",
};
inline constexpr Text restarted_before_save{
    "node {} restarted before SAVE: its RAM no longer holds what was to be saved, nothing was "
    "saved",
    "ノード {} は SAVE の前に再起動し、保存するはずの値が RAM から失われたため、保存していません",
};
inline constexpr Text saved_by_other{
    "node {1} ordered SAVE of node {0} meanwhile: ROM may hold what was meant for RAM only",
    "ノード {1} がノード {0} に SAVE を実行したため、RAM のみの変更が ROM "
    "に保存された可能性があります",
};
inline constexpr Text changed_before_save{
    "node {} no longer holds in RAM what was to be saved (it restarted, or another node wrote to "
    "it): nothing was saved",
    "ノード {} の RAM の値が保存するはずの値と異なります (再起動または別ノードによる書込み)。"
    "保存していません",
};
inline constexpr Text saved_not_verified{
    "node {} was sent SAVE and is back as node {}, but its values were not read again",
    "ノード {} は SAVE 後にノード {} として復帰しましたが、値を再読出ししていません",
};
inline constexpr Text erased_not_verified{
    "node {}: ERASE was sent, and its values were not read again: what its RAM holds is not known",
    "ノード {}: ERASE を送信しましたが、値を再読出ししていません。RAM の内容は不明です",
};
inline constexpr Text erased_not_saved{
    "node {}: its RAM holds factory defaults, and nothing was saved: a SAVE would keep them",
    "ノード {}: RAM は初期値です。保存はしていません (SAVE すると初期値が保存されます)",
};
inline constexpr Text question_restart_unknown{
    "node {}: it starts with what its ROM holds, which is not known: torque may come on, and the "
    "shaft may run to 0 deg\n",
    "ノード {}: ROM の内容 (不明) で起動します。トルクが ON になり、出力軸が 0° "
    "へ動く可能性があります\n",
};
inline constexpr Text question_restarts_unknown{
    "nodes {}: they start with what their ROM holds, which is not known: torque may come on, and "
    "the shafts may run to 0 deg\n",
    "ノード {}: ROM の内容 (不明) で起動します。トルクが ON になり、出力軸が 0° "
    "へ動く可能性があります\n",
};
inline constexpr Text question_restarts_soft{
    "nodes {}: torque is on: their outputs drop, then the shafts run slowly to 0 deg\n",
    "ノード {}: トルク ON のため、出力が一旦 OFF になり、ソフトスタートで 0° へ動きます\n",
};
inline constexpr Text question_restarts_hard{
    "nodes {}: torque is on: their outputs drop, then return where the shafts are\n",
    "ノード {}: トルク ON のため、出力が一旦 OFF になり、その位置で再び ON になります\n",
};
inline constexpr Text question_ids{
    "node IDs that are given: {}\n",
    "割り当てるノード ID: {}\n",
};
inline constexpr Text question_id_of_serial{
    "serial {}: {}",
    "製造番号 {}: {}",
};
inline constexpr Text question_id_of_node{
    "node {}: {}",
    "ノード {}: {}",
};
inline constexpr Text question_erase_torque{"node {}: torque comes on\n",
                                            "ノード {}: トルクが ON になります\n"};
inline constexpr Text question_erase_rom{
    "nothing is saved: a restart should bring back what ROM holds; but the specification also says "
    "that ROM is erased, and then that is lost\n",
    "保存はしません。再起動すると ROM の値に戻る見込みですが、仕様書には ROM も初期化されるとの記述"
    "があり、その場合は保存済みの値が失われます\n",
};
inline constexpr Text defaults_unknown_hint{
    "see what it says of itself: blactl get --group product",
    "機種情報を確認: blactl get --group product",
};
inline constexpr Text not_saved{"node {} was written in RAM, which is not saved",
                                "ノード {} は RAM に書き込みましたが、保存していません"};
inline constexpr Text before_next_write{"interrupted before the next write to node {}",
                                        "ノード {} への次の書込みの前に中断しました"};
inline constexpr Text write_broken_off{
    "interrupted while node {} was written: RAM may hold a part of it, which is not saved",
    "ノード {} への書込み中に中断しました。RAM は一部のみ変更された可能性があり、保存していません"};
inline constexpr Text has_made_way{
    "node {} has made way for others: it is saved as node {}, and has not got node ID {} yet",
    "ノード {} は他のサーボに ID を譲りました。ノード {} として保存済みで、ノード ID {} "
    "は未設定です"};
inline constexpr Text has_made_way_by_servo_id{
    "node {} has made way for others: it is saved with servo ID {}, and has not got servo ID {} "
    "yet",
    "ノード {} は他のサーボに ID を譲りました。サーボ ID {} で保存済みで、サーボ ID {} "
    "は未設定です"};
inline constexpr Text restarted_before_erase{"node {} restarted: nothing more was sent to it",
                                             "ノード {} が再起動したため、以後は送信していません"};
inline constexpr Text opcode_refused{"node {} refused {}", "ノード {} が {} を拒否しました"};
inline constexpr Text opcode_ignored{
    "node {} neither answered {} nor carried it out, although it lives",
    "ノード {} は動作していますが、{} に応答せず実行もしませんでした",
};
inline constexpr Text did_not_restart{"node {} confirmed {} and then did not restart",
                                      "ノード {} は {} に応答しましたが再起動しませんでした"};
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
    "ノード {} の送信は受信していますが、要求に応答しません。{} が実行されたかどうかは不明です"};
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
inline constexpr Text save_not_back_hint{
    "it was given {} s (--wait SEC gives it more) and may still be writing its ROM: leave it "
    "powered, "
    "and type: blactl wait -n uid:{} --wait 60; only then check supply and cable",
    "{} 秒待ちました (--wait SEC で延長できます)。ROM 書込み中の可能性があるため電源を切らずに "
    "blactl wait -n uid:{} --wait 60 を実行し、復帰しない場合のみ電源と配線を確認して下さい",
};
inline constexpr Text waits_for_id_hint{
    "it asks for a node ID and nobody gives it one: start the allocator of this bus again, or "
    "type: blactl alloc --once",
    "ノード ID の割当てを要求していますが、応じるアロケータがありません。アロケータを再開するか、"
    "blactl alloc --once を実行して下さい",
};
inline constexpr Text erased_no_more{
    "node {} restarted: what ERASE had reset may be back",
    "ノード {} が再起動したため、初期値に戻した設定が元に戻っている可能性があります",
};
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
    "ノード {}: すべての設定を初期値に戻します。servo_id {} -> 0, static_node_id {} -> 0。"
    "指令値は 0° になります\n",
};
inline constexpr Text question_erase_keep{
    "node {}: everything but its IDs to factory defaults; commands become 0 deg\n",
    "ノード {}: ID 以外の設定を初期値に戻します。指令値は 0° になります\n",
};

} // namespace blactl::texts
