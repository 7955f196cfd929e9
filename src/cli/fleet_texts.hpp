#pragma once
// Messages of the commands on fleet files.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text export_json_needs_file{
    "--json reports on FILE: both would be on stdout",
    "--json の結果とエクスポート内容がどちらも標準出力になるため、実行できません"};
inline constexpr Text export_json_needs_file_hint{
    "give a file: blactl export fleet.json --json; or leave --json out",
    "ファイルを指定するか (blactl export fleet.json --json)、--json を外して下さい"};
inline constexpr Text export_of_one{"{} makes a file of one servo, not of {}",
                                    "{} の対象は 1 台だけです (現在の対象: {} 台)"};
inline constexpr Text export_of_one_hint{"name it: blactl export {} -n {}",
                                         "対象を指定: blactl export {} -n {}"};
inline constexpr Text export_one_form{"--recipe and --params are two forms of one file",
                                      "--recipe と --params は同時に指定できません"};
inline constexpr Text export_one_form_hint{"leave one of them out", "いずれか一方を外して下さい"};
inline constexpr Text export_has_faults{"apply would refuse what was exported: {}",
                                        "出力した内容は apply では受け付けられません: {}"};
inline constexpr Text export_replaces{
    "{} is there already, and is no export of these servos: it will be replaced.\n",
    "{} は既に存在し、対象サーボのエクスポートではありません。置き換えます。\n"};
inline constexpr Text export_written{"{} written, servos: {}\n", "{} に {} 台分を書き込みました\n"};
inline constexpr Text export_not_written{"{} is as it was: not everything was read",
                                         "{} は変更していません (読み出せなかった項目があるため)"};
inline constexpr Text fleet_entry_at{"{}  node {}", "{}  ノード {}"};
inline constexpr Text fleet_different{"{} of {} settings differ", "{1} 項目中 {0} 項目が相違"};
inline constexpr Text fleet_unchanged{"as in the file (settings: {})", "ファイルと一致 ({} 項目)"};
inline constexpr Text fleet_missing{"not there", "見つかりません"};
inline constexpr Text fleet_extra{"in no entry of the file", "このサーボはファイルにありません"};
inline constexpr Text fleet_skipped{"left out (-n)", "対象外 (-n)"};
inline constexpr Text fleet_not_compared{"not compared", "未比較"};
inline constexpr Text fleet_says_nothing{"-", "-"};
inline constexpr Text fleet_column_servo{"SERVO", "サーボ"};
inline constexpr Text fleet_column_file{"FILE", "ファイル"};
inline constexpr Text fleet_files_are_whole{"-n chooses servos, and two files have none to ask",
                                            "-n はサーボの選択用です (2 ファイルの比較では不可)"};
inline constexpr Text fleet_files_are_whole_hint{"leave -n out: both files are compared whole",
                                                 "-n を省略して下さい (ファイル全体を比較します)"};
inline constexpr Text fleet_two_stdin{"only one of the two files can be stdin",
                                      "標準入力にできるファイルは 1 つだけです"};
inline constexpr Text fleet_two_stdin_hint{"give one of them by name",
                                           "一方をファイル名で指定して下さい"};
inline constexpr Text fleet_many_files{"diff compares one file with servos, or two files: not {}",
                                       "diff の比較対象は 1 つのファイルとサーボ、または 2 つの"
                                       "ファイルです ({} 個指定)"};
inline constexpr Text fleet_many_files_hint{
    "blactl diff fleet.json, or blactl diff old.json new.json",
    "例: blactl diff fleet.json、blactl diff old.json new.json"};

inline constexpr Text params_passed_over{"{}: skipped, as they are not settings: {}",
                                         "{}: 設定ではないため無視しました: {}"};
inline constexpr Text params_without_ids{"{}: left out, as the file is for several servos: {}",
                                         "{}: 複数のサーボが対象のため除外しました: {}"};
inline constexpr Text recipe_has_counters{
    "the recipe {} has counters, which are for a production line: {}",
    "レシピ {} に生産ライン用のカウンターがあります: {}"};
inline constexpr Text recipe_has_counters_hint{
    "leave the counters out: IDs are given by blactl alloc --static, or by set",
    "カウンターを外して下さい (ID の設定: blactl alloc --static、set)"};
inline constexpr Text recipe_for_whom{"the recipe {} does not say which servos it is for",
                                      "レシピ {} には対象のサーボの記述がありません"};
inline constexpr Text recipe_for_whom_hint{"name them: -n 12-18, or -n all",
                                           "対象を指定して下さい: -n 12-18、または -n all"};
inline constexpr Text params_one_entry{
    "a parameter file or a recipe is of one servo, {} is not",
    "パラメータファイルとレシピは 1 台分ですが、{} は 1 台分ではありません"};
inline constexpr Text params_one_entry_hint{
    "compare it with the servo itself: blactl diff FILE -n ID",
    "サーボと直接比較して下さい: blactl diff FILE -n ID"};

} // namespace blactl::texts
