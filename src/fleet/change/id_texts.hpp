#pragma once
// Messages about who gets which node ID: wishes, moves, the allocation service and its table.

#include "blactl/base/text.hpp"

namespace blactl::texts {

// Wishes.
inline constexpr Text several_wanted{"{} means several units: {}",
                                     "{} に該当するユニットが複数あります: {}"};
inline constexpr Text several_wanted_hint{
    "name each by what only it has: serial:, servo:, or its unique ID",
    "serial:、servo:、固有 ID などで 1 台ずつ指定して下さい"};
inline constexpr Text wished_twice{"{} means uid:{}, which was named before",
                                   "{} は uid:{} を示しますが、既に指定されています"};
inline constexpr Text wished_twice_hint{"name each servo once",
                                        "各サーボを 1 回だけ指定して下さい"};
inline constexpr Text range_needs_serials{
    "the serial number of node {} could not be read, and --range goes by serial numbers",
    "ノード {} の製造番号を読み出せません (--range は製造番号順に割り当てます)"};
inline constexpr Text range_needs_serials_hint{"repeat it, or give IDs by --assign",
                                               "再実行するか、--assign で指定して下さい"};
inline constexpr Text range_too_small{
    "of the node IDs {} to {} no node on the bus has {}, and servos that need one are {}",
    "ノード ID {}～{} の空きは {} 個ですが、{} 台に必要です"};
inline constexpr Text range_too_small_hint{"nothing was changed; give a wider --range",
                                           "変更していません。--range を広げて下さい"};
inline constexpr Text wished_id_in_use{
    "node ID {} cannot be that of uid:{}: another node on this bus has it",
    "ノード ID {} はこのバスの他のノードが使用しているため、uid:{} に割り当てられません"};
inline constexpr Text wished_id_in_use_hint{"see who: blactl scan", "使用状況の確認: blactl scan"};
inline constexpr Text wish_takes_over{
    "node ID {} was that of uid:{}, which is not on this bus: uid:{} gets it",
    "ノード ID {} の割当て先 uid:{} はこのバスにないため、uid:{} に割り当てます"};

// Moves.
inline constexpr Text will_make_way{
    "node {} makes way for others: it is saved twice, node ID {} comes in between",
    "ノード {} は ID 入替えのため一時的にノード ID {} を使用します (保存は 2 回)"};
inline constexpr Text will_ask_for_another_id{
    "node {} leaves its node ID to another servo, and asks for one after its restart",
    "ノード {} はノード ID を他のサーボに譲り、再起動後に別の ID の割当てを要求します"};
inline constexpr Text asked_and_elsewhere{
    "node {} was to leave its node ID to another servo, and has got it again",
    "ノード {} はノード ID を他のサーボに譲るはずでしたが、同じ ID で復帰しました"};
inline constexpr Text id_is_not_left{
    "node {} was to get node ID {}, whose holder has failed and may still have it: nothing was "
    "changed",
    "ノード {} に割り当てるノード ID {} "
    "は、変更に失敗したサーボが使用している可能性があるため、変更して"
    "いません"};
inline constexpr Text stays_out_of_the_way{
    "node {} is saved with this node ID, which was to be temporary: its holder has failed, and may "
    "still have node ID {}",
    "ノード {} は一時的なノード ID のまま保存されています (変更に失敗したサーボがノード ID {} "
    "を使用している可能性があります)"};
inline constexpr Text will_make_way_by_servo_id{
    "node {} makes way for others: it is saved twice, servo ID {} comes in between",
    "ノード {} は ID 入替えのため一時的にサーボ ID {} を使用します (保存は 2 回)"};
inline constexpr Text servo_id_is_not_left{
    "node {} was to get servo ID {}, whose holder has failed and may still have it: nothing was "
    "changed",
    "ノード {} に割り当てるサーボ ID {} "
    "は、変更に失敗したサーボが使用している可能性があるため、変更していません"};
inline constexpr Text servo_id_stays_out_of_the_way{
    "node {} is saved with servo ID {}, which was to be temporary: the holder of servo ID {} has "
    "failed, and may still have it",
    "ノード {} は一時的なサーボ ID {} のまま保存されています (変更に失敗したサーボがサーボ ID {} "
    "を使用している可能性があります)"};
inline constexpr Text no_temporary_servo_id{
    "node {} must make way for others, and no servo ID is free for it in the meantime",
    "ノード {} の ID 入替えに必要な空きサーボ ID がありません"};
inline constexpr Text no_temporary_servo_id_hint{
    "take a servo off the bus, and run the command again",
    "サーボを 1 台取り外してから再実行して下さい"};
inline constexpr Text id_taken_over{
    "node ID {} was given to uid:{}, which is not on this bus: node {} gets it now",
    "ノード ID {} の割当て先 uid:{} はこのバスにないため、ノード {} に割り当てます"};
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

// The allocation service, static IDs.
inline constexpr Text oldest_id_taken_over{
    "node ID {} was that of uid:{}, which was not seen for the longest time: uid:{} gets it",
    "ノード ID {} は、最も長く接続されていない uid:{} の割当てを解除し、uid:{} に割り当てます"};
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

} // namespace blactl::texts
