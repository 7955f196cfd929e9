#pragma once
// The catalogue of changes.

#include "blactl/base/text.hpp"

namespace blactl::texts {

// Messages about a change as a whole, before it.
inline constexpr Text came_since{
    "node {} has come to the bus since the servos were looked for: nothing was written",
    "サーボの検索後にノード {} がバスに加わったため、書込みを行っていません"};
inline constexpr Text did_not_tell_ids{
    "node {} did not say which IDs it has: a conflict with it cannot be ruled out",
    "ノード {} の ID を読み出せないため、重複の有無は確認できません"};
inline constexpr Text will_make_way{
    "node {} makes way for others: it is saved twice, node ID {} comes in between",
    "ノード {} は ID 入替えのため一時的にノード ID {} を使用します (保存は 2 回)"};
inline constexpr Text id_taken_over{
    "node ID {} was given to uid:{}, which is not on this bus: it is node {}'s from now on",
    "ノード ID {} の割当て先 uid:{} はこのバスにないため、ノード {} に割り当てます"};

// Messages about loans, which today are all of torque.
inline constexpr Text loan_not_back{"node {}: torque was not put back: {}",
                                    "ノード {}: トルクを元に戻せませんでした: {}"};
inline constexpr Text loan_back_hint{"to put it back: blactl set {}={} -n {}",
                                     "元に戻すには: blactl set {}={} -n {}"};
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

// Messages about the allocation of node IDs: the allocation service, static IDs.
inline constexpr Text other_allocator{"node {}{} allocates node IDs as well",
                                      "ノード {}{} もノード ID を割り当てています"};
inline constexpr Text other_allocator_hint{
    "two tables would give an ID twice: end one of the allocators, then run the command again",
    "割当てが重複する恐れがあります。一方のアロケータを停止してから再実行して下さい"};
inline constexpr Text allocated_id_in_use{
    "the allocation table gives node ID {} to uid:{}, but {} uses it",
    "ノード ID {} は割当て表では uid:{} のものですが、{} が使用しています"};
inline constexpr Text allocated_id_in_use_hint{
    "give one of them another ID: blactl alloc --assign {}=ID",
    "いずれかに別の ID を指定して下さい: blactl alloc --assign {}=ID"};

inline constexpr Text allocated_id_doubled{
    "two units use node ID {}, which was given to uid:{}",
    "ノード ID {} (割当て先 uid:{}) を 2 台が使用しています"};
inline constexpr Text same_unique_id{"node {} and a unit that asks for a node ID have the same "
                                     "unique ID: {}",
                                     "ノード {} と割当て要求中の機器の固有 ID が同一です: {}"};
inline constexpr Text same_unique_id_hint{
    "no two units may have the same: disconnect one of them",
    "固有 ID の重複は許されません。どちらか一方を取り外して下さい"};
inline constexpr Text allocated_not_up{
    "node ID {} was given to uid:{}, which does not answer on it",
    "ノード ID {} を uid:{} に割り当てましたが、応答がありません"};
inline constexpr Text allocated_not_up_hint{
    "see whether it is there: blactl scan; then run it again",
    "接続を確認 (blactl scan) してから再実行して下さい"};
inline constexpr Text allocated_not_taken{
    "node ID {} was given to uid:{} again and again: it does not accept it, and still asks",
    "ノード ID {} を uid:{} に繰り返し割り当てましたが、反映されず要求が続いています"};
inline constexpr Text allocated_not_taken_hint{
    "power it off and on; if it still asks, frames get lost or it is faulty: blactl trace --type "
    "Allocation",
    "電源を入れ直して下さい。改善しない場合は、フレームの欠落または故障の可能性があります: "
    "blactl trace --type Allocation"};

inline constexpr Text two_ids_for_unit{"uid:{} is given two static node IDs, {} and {}",
                                       "uid:{} に固定ノード ID {} と {} が指定されています"};
inline constexpr Text one_id_for_two_units{
    "static node ID {} is given to two units, uid:{} and uid:{}",
    "固定ノード ID {} が 2 台に指定されています: uid:{}、uid:{}"};
inline constexpr Text id_for_each_unit_hint{
    "give each unit one ID of its own: blactl alloc --static --assign UID=ID",
    "機器ごとに別の ID を 1 つ指定して下さい: blactl alloc --static --assign UID=ID"};
inline constexpr Text no_static_id{"uid:{} cannot have static node ID {}",
                                   "uid:{} に固定ノード ID {} は設定できません"};
inline constexpr Text no_static_id_hint{
    "type an ID from 1 to 125; for a dynamic one: blactl set -n uid:{} static_node_id=0 --save",
    "1～125 を指定して下さい。動的割当てにするには: "
    "blactl set -n uid:{} static_node_id=0 --save"};
inline constexpr Text id_given_is_kept{
    "node {} would get node ID {}, which another node uses or was promised",
    "ノード {} に設定されるノード ID {} は、別のノードが使用中または割当て済みです"};
inline constexpr Text id_given_is_kept_hint{
    "see which IDs are taken: blactl scan; blactl alloc --list",
    "使用中の ID を確認: blactl scan; blactl alloc --list"};
inline constexpr Text id_given_is_held{
    "node {} would get node ID {}, which node {} (uid:{}) has or gets with its next restart",
    "ノード {} に設定されるノード ID {} は、ノード {} (uid:{}) の現在または再起動後の ID "
    "と重複します"};
inline constexpr Text id_given_is_held_hint{"give that unit another ID at the same time: in the "
                                            "file, or with alloc --static --assign {}=ID",
                                            "その機器にも同時に別の ID を指定して下さい "
                                            "(ファイル内、または alloc --static --assign {}=ID)"};
inline constexpr Text no_temporary_id{
    "no node ID from 1 to 125 is free: units that exchange theirs need one for a moment",
    "ノード ID 1～125 に空きがありません。ID の入替えには一時的に空きが 1 つ必要です"};
inline constexpr Text no_temporary_id_hint{
    "disconnect a node, or forget a unit that is gone: blactl alloc --list; blactl alloc --forget "
    "UID",
    "ノードを 1 台外すか、使わなくなった機器を削除して下さい: blactl alloc --list; "
    "blactl alloc --forget UID"};
inline constexpr Text saved_and_elsewhere{
    "node {} has saved static node ID {} and came back under another",
    "ノード {} は固定ノード ID {} を保存しましたが、別の ID で復帰しました"};

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
inline constexpr Text plan_rom_proven{"its ROM was proven since", "その後 ROM が確認されました"};
inline constexpr Text plan_rom_not_proven{"what its ROM holds is not known any more",
                                          "ROM の内容が不明になりました"};

} // namespace blactl::texts
