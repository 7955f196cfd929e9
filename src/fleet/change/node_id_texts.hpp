#pragma once
// Messages about the allocation of node IDs: the allocation service, static IDs.

#include "blactl/base/text.hpp"

namespace blactl::texts {

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
