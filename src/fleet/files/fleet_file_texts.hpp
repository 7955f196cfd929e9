#pragma once
// Messages about fleet files.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text fleet_value_kind{"must be a number or a text such as \"90.0deg\"",
                                       "数値、または \"90.0deg\" のような文字列を入れて下さい"};
inline constexpr Text fleet_no_setting{
    "{} is not a setting: a fleet file holds what a save keeps, and can be read and written",
    "{} は設定ではありません (フリートファイルの対象は、ROM に保存され読み書きできるものだけです)"};
inline constexpr Text fleet_set_twice{"{} is there twice, by address and by name",
                                      "{} がアドレスと名前で 2 回指定されています"};
inline constexpr Text id_is_none{"0 is not a static node ID: the servo would ask for one",
                                 "0 は固定ノード ID ではありません (サーボが割当てを要求します)"};
inline constexpr Text fleet_no_unique_id{"\"unique_id\" must be 32 hexadecimal digits",
                                         "\"unique_id\" は 16 進数 32 桁でなければなりません"};
inline constexpr Text fleet_no_model{"there is no model '{}'; blactl models lists them",
                                     "機種 '{}' はありません (一覧: blactl models)"};
inline constexpr Text fleet_empty_match{
    "it would match every servo: give unique_id, serial_number, servo_id, node_id or model",
    "すべてのサーボに一致します。unique_id、serial_number、servo_id、node_id、model の"
    "いずれかを指定して下さい"};
inline constexpr Text fleet_no_name{"\"name\" must not be empty", "\"name\" が空です"};
inline constexpr Text fleet_id_of_many{
    "{} for all servos of a model: match one servo by unique_id or serial_number",
    "{} が同じ機種のすべてのサーボで同じ値になります。unique_id か serial_number で 1 台を"
    "指定して下さい"};
inline constexpr Text fleet_not_found_again{
    "this changes the {} that the entry finds its servo by: a second run would hit another one "
    "or none; match by unique_id or serial_number",
    "このエントリがサーボの照合に使う {} を変更します。2 回目の実行では別のサーボに一致するか、"
    "一致しなくなります。unique_id か serial_number で照合して下さい"};
inline constexpr Text fleet_name_twice{"this name is also in line {}",
                                       "この名前は {} 行目にもあります"};
inline constexpr Text fleet_servo_twice{"the entry in line {} means the same servo",
                                        "{} 行目のエントリも同じサーボを指しています"};
inline constexpr Text fleet_id_twice{"{} {} is also given by the entry in line {}",
                                     "{} {} は {} 行目のエントリにもあります"};
inline constexpr Text fleet_entry_means_several{
    "the entry \"{}\" means several servos: nodes {}",
    "エントリ \"{}\" が複数のサーボに一致します: ノード {}"};
inline constexpr Text fleet_entry_means_several_hint{
    "match by unique_id, which no other servo has: blactl scan shows it",
    "固有 ID (unique_id) で照合して下さい (確認: blactl scan)"};
inline constexpr Text fleet_servo_meant_twice{
    "node {} is meant by two entries: \"{}\" and \"{}\"",
    "ノード {} が 2 つのエントリに一致します: \"{}\" と \"{}\""};
inline constexpr Text fleet_passing_id{
    "the entry \"{0}\" finds node {1} by a node ID that the servo has only for now",
    "エントリ \"{0}\" はノード {1} を一時的なノード ID で照合しています"};
inline constexpr Text fleet_passing_id_hint{
    "match by unique_id or serial_number, or make the ID static: blactl alloc --static",
    "unique_id か serial_number で照合するか、ID を固定して下さい: blactl alloc --static"};

inline constexpr Text fleet_too_many{"{} has more servos than a bus has room for: 125",
                                     "{} のサーボの台数がバスの上限 125 台を超えています"};
inline constexpr Text fleet_too_many_hint{"split the file, a bus in each",
                                          "バスごとにファイルを分割して下さい"};

} // namespace blactl::texts
