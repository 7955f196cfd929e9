#pragma once
// Messages of `blactl alloc`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text alloc_no_wish{"--assign {}: SELECTOR=ID is needed",
                                    "--assign {}: SELECTOR=ID の形式で指定して下さい"};
inline constexpr Text alloc_wish_hint{
    "for example --assign serial:240900558=21, each servo and each ID once",
    "例: --assign serial:240900558=21 (サーボとノード ID の重複は不可)"};
inline constexpr Text alloc_wish_twice{"--assign {}: this servo or this ID was given before",
                                       "--assign {}: サーボまたはノード ID が重複しています"};
inline constexpr Text alloc_no_id{"node ID {} cannot be allocated",
                                  "ノード ID {} は割り当てられません"};
inline constexpr Text alloc_no_id_hint{"give one from 1 to 125; 126 and 127 are for tools",
                                       "1～125 を指定して下さい。126 と 127 はツール用です"};
inline constexpr Text alloc_no_range{"--range {}: not a range of node IDs",
                                     "--range {}: ノード ID の範囲ではありません"};
inline constexpr Text alloc_range_hint{"for example --range 10-99, within 1 to 125",
                                       "例: --range 10-99 (1～125 の範囲内)"};
inline constexpr Text alloc_no_unit{"{} does not name one servo", "{} は 1 台のサーボを示しません"};
inline constexpr Text alloc_no_unit_hint{
    "a unique ID or its beginning (0011aa, uid:0011aa), serial:240900558, servo:3, or a node ID",
    "固有 ID またはその先頭 (0011aa、uid:0011aa)、serial:240900558、servo:3、またはノード ID "
    "を指定して下さい"};
inline constexpr Text alloc_one_thing{"{} and {} do not go together",
                                      "{} と {} は同時に指定できません"};
inline constexpr Text alloc_one_thing_hint{"leave one of them out", "どちらか一方を指定して下さい"};
inline constexpr Text alloc_column_node{"NODE", "ノード"};
inline constexpr Text alloc_column_unit{"UNIQUE ID", "固有 ID"};
inline constexpr Text alloc_column_since{"LAST SEEN", "最終確認日時"};
inline constexpr Text alloc_column_state{"STATE", "状態"};
inline constexpr Text alloc_column_servo{"SERVO", "サーボ"};
inline constexpr Text alloc_table_empty{"the allocation table is empty\n", "割当て表は空です\n"};
inline constexpr Text alloc_forgotten{"forgotten: {}\n", "削除しました: {}\n"};
inline constexpr Text alloc_not_in_table{"{} is not in the allocation table",
                                         "{} は割当て表にありません"};
inline constexpr Text alloc_not_in_table_hint{"see what is: blactl alloc --list",
                                              "一覧: blactl alloc --list"};
inline constexpr Text alloc_several_begin_so{
    "{} is the beginning of {} unique IDs in the allocation table",
    "{} で始まる固有 ID は割当て表に {} 件あります"};
inline constexpr Text alloc_forget_all_question{
    "All {} units leave the allocation table: those without a static node ID may get another "
    "one.\n",
    "割当て表の全 {} 件を削除します。静的ノード ID のないサーボの ID が変わる場合があります。\n"};
inline constexpr Text alloc_forget_absent_question{
    "The units that leave the allocation table, as they are not on this bus, are {}.\n",
    "このバスにない {} 件を割当て表から削除します。\n"};
inline constexpr Text alloc_export_json_needs_file{
    "--json reports on FILE: both would be on stdout",
    "--json の結果と割当て表がどちらも標準出力になるため、実行できません"};
inline constexpr Text alloc_export_json_needs_file_hint{
    "give a file: blactl alloc --export table.json --json; or leave --json out",
    "ファイルを指定するか (blactl alloc --export table.json --json)、--json を外して下さい"};
inline constexpr Text alloc_export_over_other{
    "--export {}: that file is there, and is no allocation table",
    "--export {}: 既存のファイルで、ID 割当て表ではありません"};
inline constexpr Text alloc_exported{"entries written to {1}: {0}\n",
                                     "{} 件を {} に書き込みました\n"};
inline constexpr Text alloc_imported{"entries taken over from {1}: {0}\n",
                                     "{1} から {0} 件を取り込みました\n"};

inline constexpr Text alloc_started{"node IDs {} to {} are given to units that ask; free: {}",
                                    "ノード ID {}～{} の割当てを開始しました (空き {} 個)"};
inline constexpr Text alloc_few_left{"node IDs that no node on the bus has: {}",
                                     "空きノード ID は残り {} 個です"};
inline constexpr Text alloc_quiet{
    "nobody has asked for {} s; a unit without a node ID asks at least once a second",
    "{} 秒間、割当て要求がありませんでした (ノード ID 未割当てのサーボは 1 "
    "秒以内の間隔で要求します)"};
inline constexpr Text alloc_quiet_others{
    "no other unit has asked for {} s; those that get no node ID go on asking",
    "割当て不可の機器を除き、{} 秒間、割当て要求がありませんでした"};
inline constexpr Text alloc_not_kept{
    "a private simulation: this allocation table ends with the command",
    "シミュレーションのため、割当て表はコマンド終了後に残りません"};
inline constexpr Text alloc_wish_taken{"uid:{} gets node ID {} when it asks",
                                       "uid:{} の要求時にノード ID {} を割り当てます"};
inline constexpr Text alloc_serial{"serial {}", "製造番号 {}"};
inline constexpr Text alloc_event_request{"asks for a node ID", "割当てを要求"};
inline constexpr Text alloc_event_assigned{"gets node ID {}, new in the table",
                                           "ノード ID {} を新規割当て"};
inline constexpr Text alloc_event_kept{"gets node ID {}, as the table says",
                                       "ノード ID {} を再割当て"};
inline constexpr Text alloc_event_made_static{"node ID {} for good, proven by a restart",
                                              "ノード ID {} を固定 (再起動後に確認済み)"};
inline constexpr Text alloc_event_static{"node ID {} for good already, nothing saved",
                                         "ノード ID {} は固定済み (保存不要)"};
inline constexpr Text alloc_event_makes_way{"makes way: node ID {} for the time being",
                                            "ID 入替えのため、一時的にノード ID {} に移動"};
inline constexpr Text alloc_only_static{"{} needs --static", "{} には --static が必要です"};
inline constexpr Text alloc_only_static_hint{"for example: blactl alloc --static -n 12 --id 20",
                                             "例: blactl alloc --static -n 12 --id 20"};
inline constexpr Text alloc_several_for_id{"--id {} is one ID, and {} servos are meant",
                                           "--id {} は 1 台分ですが、対象は {} 台です"};
inline constexpr Text alloc_several_for_id_hint{
    "name one servo with -n, or give each its own: --range A-B, --assign SELECTOR=ID",
    "-n で 1 台を指定するか、--range A-B または --assign SELECTOR=ID で個別に指定して下さい"};
inline constexpr Text alloc_state_there{"there", "接続中"};
inline constexpr Text alloc_state_given{"given, no answer yet", "割当て済み (応答待ち)"};
inline constexpr Text alloc_state_refused{"refused", "割当て不可"};
inline constexpr Text alloc_state_shared{"used by two units", "ID 重複"};
inline constexpr Text alloc_event_deaf{"still asks: it does not accept node ID {}",
                                       "ノード ID {} が反映されず、要求が継続"};
inline constexpr Text alloc_asking{"asking for a node ID: {}\n", "割当て要求中: {} 台\n"};
inline constexpr Text alloc_expected_more{"units with a node ID: {}, expected: {}",
                                          "ノード ID を取得したユニットは {} 台です ({} 台の予定)"};
inline constexpr Text alloc_expected_more_hint{
    "is every servo powered and connected? one with a node ID of its own does not ask",
    "電源と配線を確認して下さい。静的ノード ID を持つサーボは要求しません"};
inline constexpr Text alloc_unfinished{"units that asked on for {1} s, and never to the end: {0}",
                                       "{} 台が {} 秒間要求を続けましたが、完了しません"};
inline constexpr Text alloc_unfinished_hint{
    "frames get lost, or the unit does not follow DroneCAN: blactl trace --type Allocation",
    "フレームの欠落、または DroneCAN 以外の機器の可能性があります: blactl trace --type Allocation"};

} // namespace blactl::texts
