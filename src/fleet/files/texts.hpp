#pragma once
// The catalogue of files: what is wrong with one.

#include "blactl/base/text.hpp"

namespace blactl::texts {

// Messages about fleet files.
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
inline constexpr Text entry_may_be{
    "no servo for '{}': {}; node {} is on the bus, but has not said who it is",
    "'{}' のサーボがありません: {}。ノード {} はバス上にありますが、情報を取得できません"};
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

// Messages about a servo in place of a broken one.
inline constexpr Text fleet_no_entry{"{} has no entry '{}'", "{} にエントリ '{}' はありません"};
inline constexpr Text fleet_no_entry_hint{"its entries: {}", "エントリ: {}"};
inline constexpr Text fleet_fact_untold{"node {} did not report its {}",
                                        "ノード {} の {} を取得できません"};
inline constexpr Text fleet_fact_untold_hint{"run the command again", "もう一度実行して下さい"};
inline constexpr Text successor_of_all{"'{}' is for every servo of its model, not for one",
                                       "'{}' は 1 台ではなく、その機種の全サーボ用のエントリです"};
inline constexpr Text successor_of_all_hint{"a new one gets it by blactl apply {}",
                                            "新しいサーボには blactl apply {} で設定できます"};
inline constexpr Text successor_none{
    "there is no servo for the place of '{}': each one on this bus has an entry of {}",
    "'{}' の代わりのサーボがありません (バス上のサーボはすべて {} にエントリがあります)"};
inline constexpr Text successor_none_hint{"connect the new one, and run the command again",
                                          "新しいサーボを接続し、もう一度実行して下さい"};
inline constexpr Text successor_waits_hint{
    "{} asked for a node ID, and got none in this run: blactl alloc --once, then the command again",
    "ノード ID の割当て待ち: {} 台。blactl alloc --once の後、もう一度実行して下さい"};
inline constexpr Text successor_several{"{} servos have no entry of {}: nodes {}",
                                        "エントリのないサーボが {} 台あります ({}): ノード {}"};
inline constexpr Text successor_several_hint{"say which one is meant: -n {}",
                                             "対象を指定して下さい (例: -n {})"};
inline constexpr Text successor_old_there{"the servo of '{}' still answers: node {}",
                                          "'{}' のサーボがまだ応答しています: ノード {}"};
inline constexpr Text successor_old_waits{"the servo of '{}' still asks for a node ID",
                                          "'{}' のサーボがまだノード ID を要求しています"};
inline constexpr Text successor_old_there_hint{
    "take it off the bus and run the command again; if it stays: blactl apply {}",
    "取り外してからもう一度実行して下さい。交換しない場合: blactl apply {}"};
inline constexpr Text successor_old_on_its_id{
    "node ID {} is used by uid:{}, which took the place of '{}', and by uid:{}, as its node ID "
    "tells "
    "the old servo{}",
    "ノード ID {} は、uid:{} ('{}' の新しいサーボ) と uid:{} (ノード ID から元のサーボと判断{}) "
    "の両方が使用しています"};
inline constexpr Text successor_old_serial{" (serial number {})", "、製造番号 {}"};
inline constexpr Text successor_old_on_its_id_hint{
    "take the old one off the bus, then run the same command again",
    "元のサーボを取り外してから、同じコマンドをもう一度実行して下さい"};
inline constexpr Text successor_has_entry{"node {} has an entry of its own: '{}'",
                                          "ノード {} には別のエントリがあります: '{}'"};
inline constexpr Text successor_has_entry_hint{"name the new servo with -n",
                                               "-n で新しいサーボを指定して下さい"};
inline constexpr Text successor_model{"node {} is a {}, '{}' is for a {}",
                                      "ノード {} の機種は {} です ('{}' の機種: {})"};
inline constexpr Text successor_model_hint{
    "if another model is meant: blactl apply {} --entry {} -n {}",
    "別の機種でよい場合: blactl apply {} --entry {} -n {}"};

// Messages about labels.
inline constexpr Text label_line{"label {}", "ラベル {}"};
inline constexpr Text label_wrong{"label {}: '{}' is not a serial number",
                                  "ラベル {}: '{}' は製造番号ではありません"};
inline constexpr Text label_wrong_hint{
    "a line is a serial number, or an object such as {{\"serial_number\": 240900558}}",
    "1 行に製造番号、または {{\"serial_number\": 240900558}} のようなオブジェクトを入力して下さい"};

// Messages about parameter files.
inline constexpr Text params_no_pair{
    "a line must hold the address of a register and its number, such as: 0x38 900",
    "1 行にレジスタのアドレスと値を 1 つずつ記述して下さい (例: 0x38 900)"};
inline constexpr Text params_decimal_name{
    "is it 0x{0}, or the decimal number {0}? addresses are hexadecimal here, such as 0x38",
    "0x{0} と 10 進数の {0} のどちらか判別できません。アドレスは 16 進数で記述して下さい "
    "(例: 0x38)"};
inline constexpr Text params_own_name{
    "write the address {0}: the values of a parameter file are register numbers, whose unit a name "
    "leaves open",
    "アドレス {0} を記述して下さい。パラメータファイルの値はレジスタ値のため、名前では単位が"
    "判別できません"};
inline constexpr Text params_unknown_name{
    "no register of a BLA servo: they go by their address here, such as 0x38",
    "BLA サーボのレジスタではありません。アドレスを記述して下さい (例: 0x38)"};
inline constexpr Text params_not_whole{
    "'{}' is not a register number: those are integers without a unit",
    "'{}' はレジスタ値ではありません (レジスタ値は単位の無い整数です)"};
inline constexpr Text params_twice{"this register is also in line {}",
                                   "このレジスタは {} 行目にもあります"};
inline constexpr Text params_empty{"no setting of a BLA servo is in this file",
                                   "BLA サーボの設定がありません"};
inline constexpr Text params_several{
    "{} does not say which servo it is for, and there are several: nodes {}",
    "{} には対象のサーボの記述が無く、サーボが複数あります: ノード {}"};
inline constexpr Text params_several_hint{"name one of them: -n {}; or all that are meant",
                                          "1 台を指定するか (-n {})、対象をすべて指定して下さい"};
inline constexpr Text params_only_ids{
    "{} has only IDs, and no two servos can have the same one",
    "{} の設定は ID だけです (同じ ID を複数のサーボに設定することはできません)"};
inline constexpr Text params_only_ids_hint{"name one servo with -n", "-n で 1 台を指定して下さい"};

// Messages about recipes.
inline constexpr Text recipe_counter_of{
    "{} is not an ID: only servo_id and static_node_id are counted",
    "{} は ID ではありません。カウンターは servo_id と static_node_id のみに指定できます"};
inline constexpr Text recipe_counter_ends{"\"last\" is {}, below \"first\", {}",
                                          "\"last\" ({}) が \"first\" ({}) より小さい値です"};
inline constexpr Text recipe_id_of_many{"{} would give the same {} to {} servos",
                                        "{} の {} は 1 台にのみ設定できます (現在の対象: {} 台)"};
inline constexpr Text recipe_id_of_many_hint{
    "name one servo with -n, or leave it out of the recipe",
    "-n で 1 台を指定するか、レシピから外して下さい"};
inline constexpr Text recipe_other_model{"it is a {}, the recipe is for {}",
                                         "機種は {} です (レシピの機種: {})"};
inline constexpr Text recipe_unknown_model{"unknown model", "不明な機種"};
inline constexpr Text recipe_other_model_hint{
    "leave it out of -n, or take a recipe for its model",
    "-n の対象から外すか、その機種のレシピを使用して下さい"};
inline constexpr Text recipe_needs_newer{"its firmware is {}, the recipe needs {} or later",
                                         "ファームウェアは {} です (レシピの条件: {} 以降)"};
inline constexpr Text recipe_needs_newer_hint{"have its firmware updated",
                                              "ファームウェアを更新して下さい"};
inline constexpr Text servo_silent_on{"it did not report its {}", "{} の応答がありません"};

} // namespace blactl::texts
