#pragma once
// Messages of `blactl undo`, and of its record.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text change_not_recorded{
    "this change is not recorded, so `blactl undo` does not know it: {}",
    "この変更は変更履歴に記録されないため、`blactl undo` では戻せません: {}"};

inline constexpr Text end_not_recorded{
    "how this change ended is not recorded, so `blactl undo` takes it for carried out: {}",
    "変更の結果が変更履歴に記録されないため、`blactl undo` は変更済みとして扱います: {}"};
inline constexpr Text state_not_written{
    "what the servos hold cannot be recorded for `blactl undo`: {}",
    "変更前の値を変更履歴に記録できません: {}"};
inline constexpr Text state_not_written_hint{
    "fix that, or add --no-snapshot to do without `blactl undo`: nothing was written",
    "原因を取り除くか、--no-snapshot を指定して下さい (その場合 `blactl undo` では戻せません)。"
    "何も書き込んでいません"};

inline constexpr Text undo_takes_back{"takes back what `{}` changed at {}",
                                      "`{}` による変更 ({}) を元に戻します"};
inline constexpr Text undo_missing{"unit {}, which `{}` changed, is not on the bus",
                                   "固有 ID {} のサーボ (`{}` で変更) がバス上にありません"};
inline constexpr Text undo_unit_twice{
    "two nodes have the unique ID {}: which of them was changed is not known",
    "固有 ID {} のノードが 2 つあり、どちらの変更か判定できません"};
inline constexpr Text undo_unit_twice_hint{"connect only the one that is meant",
                                           "対象のサーボだけを接続して下さい"};
inline constexpr Text undo_nothing_of_node{"no change of node {} is recorded",
                                           "ノード {} の変更履歴はありません"};
inline constexpr Text undo_see_list_hint{"what is recorded: blactl undo --list",
                                         "変更履歴の表示: blactl undo --list"};
inline constexpr Text undo_nothing_at_all{"no change of a servo is recorded",
                                          "サーボの変更履歴がありません"};
inline constexpr Text undo_nothing_at_all_hint{
    "each user has a record of their own, and -i sim: has one, too",
    "変更履歴はユーザーごとに保存されます (-i sim: の履歴は別です)"};
inline constexpr Text undo_list_alone{"--list goes with neither -n nor --dry-run nor --no-save",
                                      "--list は -n、--dry-run、--no-save と同時に指定できません"};
inline constexpr Text undo_list_alone_hint{"it lists all changes: blactl undo --list",
                                           "すべての変更履歴の表示: blactl undo --list"};

inline constexpr Text undo_nothing_recorded{"no change is recorded\n", "変更履歴は空です\n"};
inline constexpr Text undo_column_time{"TIME", "日時"};
inline constexpr Text undo_column_unit{"UNIQUE ID", "固有 ID"};
inline constexpr Text undo_column_command{"COMMAND", "コマンド"};
inline constexpr Text undo_column_count{"SETTINGS", "項目数"};
inline constexpr Text undo_column_saved{"CHANGED IN", "書込み先"};
inline constexpr Text undo_in_ram{"RAM", "RAM"};
inline constexpr Text undo_in_rom{"RAM and ROM", "RAM と ROM"};

} // namespace blactl::texts
