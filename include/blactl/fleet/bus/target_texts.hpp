#pragma once
// Messages about the selected nodes, and which of them are present.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text node_not_found{"node {} is not on the bus", "ノード {} はバス上にありません"};
inline constexpr Text node_not_found_hint{"see who is there: blactl scan",
                                          "接続中のノードを確認: blactl scan"};
inline constexpr Text not_a_servo{"node {} ({}) is not a BLA servo",
                                  "ノード {} ({}) は BLA サーボではありません"};
inline constexpr Text no_servo_found{"no BLA servo is on the bus",
                                     "バス上に BLA サーボがありません"};
inline constexpr Text no_servo_found_hint{
    "a servo without a node ID shows in: blactl scan",
    "ノード ID の無いサーボは blactl scan で確認できます",
};
inline constexpr Text no_node_is_servo{
    "nodes on the bus: {}; none is known to be a BLA servo",
    "バス上のノード ({}) に BLA サーボと判別できるものがありません"};
inline constexpr Text no_node_is_servo_hint{
    "name one by its ID, for example -n {}, or see what they are: blactl scan",
    "-n {} のように ID を指定するか、ノードの種類を確認して下さい: blactl scan"};
inline constexpr Text nothing_matches{"no servo on the bus matches {}",
                                      "{} に該当するサーボはバス上にありません"};
inline constexpr Text may_be_meant{
    "node {} is on the bus, but has not said who it is: {} may mean it",
    "ノード {} はバス上にありますが、情報を取得できません。{} に該当する可能性があります"};
inline constexpr Text target_waits_for_id{
    "{} waits for a node ID: it cannot be asked before it has one",
    "{} はノード ID の割当て待ちです。割当て前は問い合わせできません"};
inline constexpr Text target_waits_for_id_hint{
    "give it a node ID: blactl alloc --once (or let the flight controller do it)",
    "ノード ID を割り当てて下さい: blactl alloc --once (フライトコントローラでも可)"};
inline constexpr Text all_wait_for_id_hint{
    "servos wait for a node ID: `blactl alloc --once` gives them one for now, or for good: "
    "blactl alloc --static -n all --range 11-40",
    "サーボがノード ID の割当てを待っています。一時的な割当ては `blactl alloc --once`、固定: "
    "blactl alloc --static -n all --range 11-40"};
inline constexpr Text foreign_actuator{
    "node {} ({}) sends actuator.Status but answers no GetSet: it is not taken for a BLA servo",
    "ノード {} ({}) は actuator.Status を送信しますが GetSet に応答しないため、BLA "
    "サーボとして扱いません",
};
inline constexpr Text node_gone{"node {} does not answer any more",
                                "ノード {} が応答しなくなりました"};
inline constexpr Text not_there_yet{"node {} was not there yet when the wait ended",
                                    "ノード {} は待機終了時点で動作していません"};
inline constexpr Text bad_target{"-n {}: not a node ID, range or selector",
                                 "-n {}: ノード ID、範囲、セレクタのいずれでもありません"};
inline constexpr Text bad_target_hint{
    "for example -n 12, -n 10-14,20, -n all, -n serial:240900558, -n model:BLA21-12U",
    "例: -n 12、-n 10-14,20、-n all、-n serial:240900558、-n model:BLA21-12U",
};
inline constexpr Text bad_target_id{"-n {}: node IDs are 1 to 127",
                                    "-n {}: ノード ID は 1～127 です"};
inline constexpr Text bad_target_id_hint{"see who is there: blactl scan",
                                         "接続中のノードを確認: blactl scan"};
inline constexpr Text bad_target_range{"-n {}: the range goes downwards",
                                       "-n {}: 範囲の大小が逆です"};
inline constexpr Text bad_target_range_hint{"type -n {}-{}", "-n {}-{} と入力して下さい"};
inline constexpr Text ambiguous_target{"-n {}: several servos have a unique ID that begins so: {}",
                                       "-n {}: 固有 ID の先頭が一致するサーボが複数あります: {}"};
inline constexpr Text waiting_unit{"{}… (waits for a node ID)", "{}… (ノード ID 割当て待ち)"};
inline constexpr Text ambiguous_target_hint{"type more of its digits",
                                            "固有 ID をより多くの桁で指定して下さい"};
inline constexpr Text doubled_serial_target{"-n {}: several servos have this serial number: {}",
                                            "-n {}: 同じ製造番号のサーボが複数あります: {}"};
inline constexpr Text several_servos{"several servos are on the bus: {}",
                                     "バス上に複数のサーボがあります: {}"};
inline constexpr Text several_servos_hint{"say which: -n {}", "-n {} のように指定して下さい"};
inline constexpr Text wait_not_operational{"node {} was heard but not operational after {} s",
                                           "ノード {} は {} 秒待っても動作状態になりません"};
inline constexpr Text wait_not_heard{"node {} was not heard within {} s",
                                     "ノード {} は {} 秒以内に見つかりませんでした"};
inline constexpr Text units_wait_for_id{
    "left out because they have no node ID: at least {} (to give them one: `blactl alloc --once`)",
    "ノード ID のないユニット {} 台以上は対象外です (割当て: `blactl alloc --once`)"};

} // namespace blactl::texts
