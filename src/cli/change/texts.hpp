#pragma once
// Messages of apply and undo.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text apply_missing{"no servo for '{}': {}", "'{}' のサーボがありません: {}"};
inline constexpr Text apply_missing_unnamed{"no servo for {}", "サーボがありません: {}"};
inline constexpr Text apply_missing_hint{
    "connect it, or name those that are meant with -n: nothing was written",
    "接続するか、-n で対象を絞り込んで下さい (何も書き込んでいません)"};
inline constexpr Text apply_nobody{"no entry of {} matches any of these servos",
                                   "{} に対象のサーボと一致するエントリがありません"};
inline constexpr Text apply_nobody_hint{"what the file says of these servos: blactl diff {}",
                                        "ファイルとサーボの比較: blactl diff {}"};
inline constexpr Text apply_may_wait_hint{
    "units that wait for a node ID: {}. It may be one of them: blactl alloc --once. Otherwise ",
    "ノード ID 割当て待ち ({} 台) に含まれる可能性があります: blactl alloc "
    "--once。それ以外の場合、"};
inline constexpr Text apply_would_let_in{
    "'{}' waits for a node ID: it would get {} first, then be compared in {} settings",
    "'{}' はノード ID 割当て待ちです。先に{}を割り当ててから、{} 項目を照合します"};
inline constexpr Text would_get_known_id{"{}, which the allocation table has for it,",
                                         "割当て表のノード ID {} "};
inline constexpr Text would_get_free_id{"a free one", "空いているノード ID "};
inline constexpr Text would_let_in_unknown{
    "a unit waits for a node ID: unique ID {}; who it is shows when it has one, which a dry run "
    "does "
    "not give",
    "ノード ID 割当て待ち: 固有 ID {} "
    "(ドライランでは割当てを行わないため、どのサーボかは不明です)"};
inline constexpr Text replace_would_let_in{
    "the unit that waits for a node ID (unique ID {}) would get {} first, and then take the place "
    "of "
    "'{}', if its model fits",
    "ノード ID 割当て待ちのユニット (固有 ID {}) に、先に{}を割り当ててから、機種が合えば '{}' "
    "の代わりに設定します"};
inline constexpr Text apply_replaced_hint{
    "connect it; if another one is there in its place: blactl replace {} {}; nothing was "
    "written",
    "接続して下さい。別のサーボに交換した場合: blactl replace {} {} (何も書き込んでいません)"};
inline constexpr Text apply_entry_one{"--entry is for one servo, not for {}",
                                      "--entry の対象は 1 台だけです (現在の対象: {} 台)"};
inline constexpr Text apply_entry_one_hint{"name one of them with -n",
                                           "-n で 1 台を指定して下さい"};
inline constexpr Text apply_without_entries{
    "{} has no entries: --entry goes with fleet files only",
    "{} にはエントリがありません (--entry はフリートファイル専用です)"};
inline constexpr Text apply_without_entries_hint{
    "leave --entry out: -n alone says which servos are meant",
    "--entry を外して下さい (対象は -n だけで指定します)"};
inline constexpr Text apply_beside{"{} has no meaning beside {}", "{} は {} と併用できません"};
inline constexpr Text apply_beside_check_hint{"leave it out: only the file is looked at",
                                              "外して下さい (確認の対象はファイルのみです)"};
inline constexpr Text apply_checked{"{}: no faults (entries: {}, settings: {})\n",
                                    "{}: 誤りなし (エントリ {} 件、設定 {} 項目)\n"};
inline constexpr Text apply_beside_plan_hint{"give it when the plan is made",
                                             "計画の作成時に指定して下さい"};
inline constexpr Text apply_not_begun{
    "node {} is as it was: an earlier step failed",
    "ノード {} は変更していません (先の変更が完了しなかったため)"};
inline constexpr Text apply_only_restarted{
    "node {} has restarted, its ROM holds other values, and nothing was written: an earlier step "
    "failed",
    "ノード {} は再起動のみ実施しました。ROM の値は指定と異なりますが、書き込んでいません "
    "(先の変更が完了しなかったため)"};
inline constexpr Text apply_skipped{"left as it was", "未処理"};
inline constexpr Text apply_changed{
    "{} of {} settings changed, saved, read again after the restart",
    "{1} 項目中 {0} 項目を変更 (保存・再起動後に再読出し)"};
inline constexpr Text held_already{"node {}: RAM and ROM hold this already: nothing was saved",
                                   "ノード {}: RAM・ROM とも一致しているため、保存していません"};
inline constexpr Text apply_saved{"saved: ROM held something else",
                                  "保存のみ実行 (ROM の値が異なっていたため)"};
inline constexpr Text apply_changed_ram{"{} of {} settings changed, in RAM only",
                                        "{1} 項目中 {0} 項目を変更 (RAM のみ)"};
inline constexpr Text apply_unchanged_proven{"unchanged, ROM too", "変更なし (ROM も確認済み)"};
inline constexpr Text apply_unchanged{"unchanged, as far as RAM shows", "変更なし (RAM のみ確認)"};
inline constexpr Text apply_failed{"failed", "失敗"};
inline constexpr Text apply_back{", back as node {} after {} s", "、ノード {} として {} 秒で復帰"};
inline constexpr Text apply_would_write_save{"would change {} of {} settings, then save",
                                             "{1} 項目中 {0} 項目を変更・保存予定"};
inline constexpr Text apply_would_write{"would change {} of {} settings, in RAM only",
                                        "{1} 項目中 {0} 項目を変更予定 (RAM のみ)"};
inline constexpr Text apply_would_save{"would only save: RAM holds it, ROM does not",
                                       "保存のみの予定 (RAM は一致、ROM は相違)"};
inline constexpr Text apply_would_prove{
    "would restart to see what ROM holds: RAM holds all settings ({})",
    "ROM 確認のため再起動予定 (RAM は全 {} 項目一致)"};
inline constexpr Text apply_would_ask{"It would ask before:\n{}\n",
                                      "実行前に確認を求めます:\n{}\n"};
inline constexpr Text apply_counts{
    "servos: {} (changed {}, unchanged {}, failed {}, left out {})\n",
    "{} 台: 変更 {}、変更なし {}、失敗 {}、未処理 {}\n"};
inline constexpr Text apply_plan_counts{"servos: {} (would be changed {}, unchanged {})\n",
                                        "{} 台: 変更予定 {}、変更なし {}\n"};
inline constexpr Text stage_waits{"waits for its turn", "待機中"};
inline constexpr Text stage_erase{"erases", "初期化中"};
inline constexpr Text stage_write{"is written", "書込み中"};
inline constexpr Text stage_save{"saves and restarts", "保存・再起動中"};
inline constexpr Text stage_restart{"restarts", "再起動中"};
inline constexpr Text stage_read{"is read again", "再読出し中"};
inline constexpr Text stage_end{"done", "完了"};
inline constexpr Text events_no_stdout{
    "stdout carries the results: events need a file",
    "標準出力は結果に使用するため、イベントにはファイルが必要です"};
inline constexpr Text events_over_file{
    "the events would be written over {}, which is applied",
    "{} は適用するファイル (FILE) のため、イベントの出力先にできません"};
inline constexpr Text events_unopened{"cannot write events to {}: {}",
                                      "{} にイベントを書き込めません: {}"};
inline constexpr Text events_unopened_hint{
    "give a file that can be written, or a pipe that is read: --events FILE",
    "書込み可能なファイル、または読み手のあるパイプを指定して下さい: --events FILE"};
inline constexpr Text events_ended{"the events in {} ended early: {}",
                                   "{} へのイベントの書込みが途中で終了しました: {}"};
inline constexpr Text events_ended_hint{
    "the results of the servos are in the output of this command",
    "各サーボの結果はこのコマンドの出力にあります"};

// Messages of `blactl undo`, and of its record.
inline constexpr Text change_not_recorded{
    "this change is not recorded, so `blactl undo` does not know it: {}",
    "この変更は変更履歴に記録されないため、`blactl undo` では戻せません: {}"};

inline constexpr Text end_not_recorded{
    "how this change ended is not recorded, so `blactl undo` takes it for carried out: {}",
    "変更の結果が変更履歴に記録されないため、`blactl undo` は変更済みとして扱います: {}"};
inline constexpr Text replace_needs_file{
    "replace changes its file: it cannot be stdin",
    "replace は FILE を書き換えるため、標準入力は指定できません"};
inline constexpr Text replace_needs_file_hint{"blactl replace fleet.json NAME",
                                              "blactl replace fleet.json NAME"};
inline constexpr Text replace_takes_place{"node {} takes the place of '{}'",
                                          "ノード {} を '{}' の代わりに設定します"};
inline constexpr Text replace_took_place{"node {} has taken the place of '{}' already",
                                         "ノード {} は '{}' の代わりに設定済みです"};
inline constexpr Text replace_names{"{}: '{}' is node {} now, {}",
                                    "{}: '{}' はノード {} になりました ({})"};
inline constexpr Text replace_keeps{
    "{} stays as it is: the entry '{}' does not tell which unit it is",
    "{} は変更していません (エントリ '{}' は個体を指定していません)"};
inline constexpr Text replace_file_changed{
    "{} was changed by somebody else meanwhile, and does not name the new servo yet",
    "{} が実行中に変更されたため、新しいサーボをまだ反映していません"};
inline constexpr Text replace_file_left{
    "the servo is done, its file is not: {}",
    "サーボの設定は完了しましたが、ファイルを更新できません: {}"};
inline constexpr Text replace_again_hint{"run the same command again",
                                         "同じコマンドをもう一度実行して下さい"};
inline constexpr Text replace_autopilot{
    "a flight controller that remembers which unit has node ID {} may call it a duplicate; "
    "ArduPilot forgets with CAN_D1_UC_OPTION = 1 and a restart (then set it to 0 again)",
    "フライトコントローラーがノード ID {} "
    "の個体を記憶している場合、重複と表示されることがあります。"
    "ArduPilot では CAN_D1_UC_OPTION = 1 にして再起動すると記憶が消去されます (その後 0 に戻す)"};

inline constexpr Text state_not_written{
    "what the servos hold cannot be recorded for `blactl undo`: {}",
    "変更前の値を変更履歴に記録できません: {}"};
inline constexpr Text state_not_written_hint{
    "fix that, or add --no-snapshot to do without `blactl undo`: nothing was written",
    "原因を取り除くか、--no-snapshot を指定して下さい (その場合 `blactl undo` では戻せません)。"
    "何も書き込んでいません"};

inline constexpr Text undo_takes_back{"takes back what `{}` changed at {}",
                                      "`{}` による変更 ({}) を元に戻します"};
inline constexpr Text undo_takes_back_since{"takes back all changes since before command {}",
                                            "コマンド {} 以降の変更をすべて元に戻します"};
inline constexpr Text undo_missing{"unit {}, which `{}` changed, is not on the bus",
                                   "固有 ID {} のサーボ (`{}` で変更) がバス上にありません"};
inline constexpr Text undo_nothing_of_node{"no change of node {} is recorded",
                                           "ノード {} の変更履歴はありません"};
inline constexpr Text undo_nothing_of_node_since{
    "node {} was not changed since before command {}, as far as recorded",
    "ノード {} はコマンド {} 以降に変更されていません"};
inline constexpr Text undo_see_list_hint{"what is recorded: blactl undo --list",
                                         "変更履歴の表示: blactl undo --list"};
inline constexpr Text undo_nothing_at_all{"no change of a servo is recorded",
                                          "サーボの変更履歴がありません"};
inline constexpr Text undo_nothing_at_all_hint{
    "each user has a record of their own, and -i sim: has one, too",
    "変更履歴はユーザーごとに保存されます (-i sim: の履歴は別です)"};
inline constexpr Text undo_list_alone{"--list goes with no other option and not with -n",
                                      "--list は -n や他のオプションと同時に指定できません"};
inline constexpr Text undo_list_alone_hint{"it lists all changes: blactl undo --list",
                                           "すべての変更履歴の表示: blactl undo --list"};

inline constexpr Text undo_nothing_recorded{"no change is recorded\n", "変更履歴は空です\n"};
inline constexpr Text undo_column_number{"NUMBER", "番号"};
inline constexpr Text undo_column_time{"TIME", "日時"};
inline constexpr Text undo_column_unit{"UNIQUE ID", "固有 ID"};
inline constexpr Text undo_column_command{"COMMAND", "コマンド"};
inline constexpr Text undo_replaced{"{} {} -> {}", "{} {} -> {}"};
inline constexpr Text undo_was{"{} was {}", "{} 変更前 {}"};
inline constexpr Text undo_more_settings{"{} and {} more", "{} 他 {} 件"};
inline constexpr Text undo_column_saved{"CHANGED IN", "書込み先"};
inline constexpr Text undo_in_ram{"RAM", "RAM"};
inline constexpr Text undo_in_rom{"RAM and ROM", "RAM と ROM"};
inline constexpr Text undo_perhaps_in_rom{"RAM, ROM not known", "RAM (ROM は不明)"};

} // namespace blactl::texts
