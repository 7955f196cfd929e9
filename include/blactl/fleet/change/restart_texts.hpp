#pragma once
// Messages about saving, erasing and restarting.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text restarts_again{
    "node {} restarts again and again while it is written to",
    "ノード {} は書込み中に何度も再起動しています",
};
inline constexpr Text unnamed_saved{
    "{} is {} in RAM and {} in ROM: SAVE keeps all of RAM, so this too",
    "{} は RAM が {}、ROM が {} です。SAVE は RAM 全体を保存するため、この値も保存されます",
};
inline constexpr Text unnamed_lost{
    "{} was {} in RAM only: the restart has brought back {}",
    "{} の {} は RAM のみの値でした。再起動により {} に戻りました",
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
inline constexpr Text changed_before_save{
    "node {} no longer holds in RAM what was to be saved (it restarted, or another node wrote to "
    "it): nothing was saved",
    "ノード {} の RAM の値が保存するはずの値と異なります (再起動または別ノードによる書込み)。"
    "保存していません",
};
inline constexpr Text saved_not_verified{
    "node {} was sent SAVE and is back, but its values were not read again",
    "ノード {} は SAVE 後に復帰しましたが、値を再読出ししていません",
};
inline constexpr Text erased_not_verified{
    "node {}: ERASE was sent, and its values were not read again: what its RAM holds is not known",
    "ノード {}: ERASE を送信しましたが、値を再読出ししていません。RAM の内容は不明です",
};
inline constexpr Text erased_not_saved{
    "node {}: its RAM holds factory defaults, its ROM was not written: a SAVE would keep them",
    "ノード {}: RAM は初期値です。ROM には保存していません (SAVE すると初期値が保存されます)",
};
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
inline constexpr Text defaults_unknown_hint{
    "see what it says of itself: blactl get --group product",
    "機種情報を確認: blactl get --group product",
};
inline constexpr Text not_saved{"node {}: ROM was not written",
                                "ノード {}: ROM に保存していません"};
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
inline constexpr Text waits_for_id_hint{
    "it asks for a node ID and nobody gives it one: start the allocator of this bus again, or "
    "type: blactl alloc --once",
    "ノード ID の割当てを要求していますが、応じるアロケータがありません。アロケータを再開するか、"
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
