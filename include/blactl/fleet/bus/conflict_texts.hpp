#pragma once
// Messages about nodes that share an ID, and about other active nodes.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text doubled_static_id{"nodes {} have the same static node ID {}",
                                        "ノード {} の固定ノード ID が {} で重複しています"};
inline constexpr Text doubled_servo_id{"nodes {} have the same servo ID {}",
                                       "ノード {} のサーボ ID が {} で重複しています"};
inline constexpr Text doubled_unique_id{
    "nodes {} have the same unique ID {}: blactl would take one for the other",
    "ノード {} の固有 ID が {} で重複しており、区別できません"};
inline constexpr Text other_serial{
    "node {} has the unique ID of this servo, and another serial number: {}, not {}",
    "ノード {} は固有 ID が同じですが、製造番号が異なります ({}、変更対象は {})"};
inline constexpr Text doubled_unique_id_hint{
    "connect one of them alone; the manufacturer gives each servo an ID of its own",
    "1 台だけ接続して下さい。固有 ID は出荷時に個別に割り当てられます"};
inline constexpr Text blank_unique_id{
    "node {} has no unique ID of its own ({}): it would not be known again after a restart",
    "ノード {} には機器個別の固有 ID がありません ({})。再起動後に同一の機器と確認できません"};
inline constexpr Text blank_unique_id_hint{"it can be read, and nothing else; ask the manufacturer",
                                           "読出しのみ可能です。メーカーにお問い合わせ下さい"};
inline constexpr Text doubled_target{"two units use node ID {}",
                                     "ノード ID {} を 2 台が使用しています"};
inline constexpr Text doubled_units{"two units use node ID {}: {}",
                                    "ノード ID {} を 2 台が使用しています: {}"};
inline constexpr Text id_given_is_taken{
    "node {} would get node ID {}, which another unit has (uid:{})",
    "ノード {} に設定されるノード ID {} は別の機器 (uid:{}) が使用しています",
};
inline constexpr Text id_given_will_be_taken{
    "node {} would get node ID {}, which node {} has, or gets once it is saved and restarts",
    "ノード {} に設定されるノード ID {} は、ノード {} の現在または保存・再起動後の ID と重複します",
};
inline constexpr Text servo_id_given_is_taken{
    "node {} would have servo ID {}, which node {} has",
    "ノード {} のサーボ ID {} はノード {} と重複します",
};
inline constexpr Text node_id_given_is_in_rom{
    "node {} would have node ID {}, which node {} has in its ROM, and gets with its next restart",
    "ノード {} のノード ID {} は、ノード {} の ROM 内の ID (再起動後の ID) と重複します",
};
inline constexpr Text node_id_given_is_in_waiting_rom{
    "node {} would have node ID {}, which is in the ROM of a unit that waits for one, and which it "
    "gets as soon as it can read its ROM",
    "ノード {} のノード ID {} は、割当て要求中の機器の ROM 内の ID (ROM を読み出せた場合の ID) "
    "と重複します",
};
inline constexpr Text node_id_given_is_in_waiting_rom_hint{
    "let it start again, or take it off: blactl alloc --once; blactl restart -n uid:{}",
    "その機器を再起動するか、取り外して下さい: blactl alloc --once; blactl restart -n uid:{}",
};
inline constexpr Text servo_id_given_is_in_rom{
    "node {} would have servo ID {}, which node {} has in its ROM, and gets with its next restart",
    "ノード {} のサーボ ID {} は、ノード {} の ROM 内の ID (再起動後の ID) と重複します",
};
inline constexpr Text servo_id_given_is_in_rom_hint{
    "if that one is to keep what it has in RAM: blactl save -n {}",
    "相手の RAM の ID を維持する場合: blactl save -n {}"};
inline constexpr Text servo_id_taken_hint{"see who has which: blactl get -n all servo_id",
                                          "各サーボの ID を確認: blactl get -n all servo_id"};
inline constexpr Text servo_id_for_several{
    "one servo ID for {} servos: a command for one would move all of them",
    "{} 台に同じサーボ ID を設定すると、一つの指令ですべてが動きます",
};
inline constexpr Text doubled_meanwhile_hint{
    "one of them, or both, may have taken what was sent: connect one of them alone, give it "
    "another "
    "ID, and look at both",
    "送信した内容は一方または両方に反映された可能性があります。1 台だけ接続して ID "
    "を変更し、両方の設定を確認して下さい",
};
inline constexpr Text doubled_target_hint{"connect one of them alone and give it another ID",
                                          "1 台だけ接続して別の ID を設定して下さい"};
inline constexpr Text armed{
    "node {} says that the vehicle is armed: nothing is written while it is",
    "ノード {} が ARM 状態を通知している間は書き込みません"};
inline constexpr Text armed_hint{"disarm it first", "先に DISARM して下さい"};
inline constexpr Text driven{"node {} commands node {}: not while it does",
                             "ノード {} がノード {} に動作指令を送信中のため実行しません"};
inline constexpr Text id_is_driven{
    "node {} commands servo ID {}, which node {} would have then: not while it does",
    "ノード {} がサーボ ID {} に動作指令を送信中で、ノード {} がその ID になるため実行しません"};
inline constexpr Text driven_hint{"stop it, or add --while-driven",
                                  "停止させるか、--while-driven を付けて下さい"};
inline constexpr Text node_id_is_ours_hint{
    "run the command with another node ID of its own: --local-node-id ID",
    "自ノードに別の ID を指定して下さい: --local-node-id ID"};
inline constexpr Text node_id_in_use_hint{"see which IDs are taken: blactl scan",
                                          "使用中の ID を確認: blactl scan"};
inline constexpr Text node_id_is_ours{"static_node_id={} is the node ID of this process",
                                      "static_node_id={} は blactl の自ノード ID と重複します"};
inline constexpr Text one_id_for_several{
    "one static node ID for {} servos: they would collide after a restart",
    "{} 台のサーボに同じ固定ノード ID を設定すると再起動後に重複します",
};
inline constexpr Text one_id_for_several_hint{"give each its own: -n {}",
                                              "1 台ずつ設定して下さい: -n {}"};
inline constexpr Text doubled_servo_id_hint{
    "give one of them another: blactl set -n {} servo_id=ID --save",
    "一方に別の ID を設定して下さい: blactl set -n {} servo_id=ID --save"};
inline constexpr Text shared_servo_id_hint{
    "nodes {} each need another ID: blactl set -n {} servo_id=ID --save",
    "ノード {} にそれぞれ別の ID を設定して下さい: blactl set -n {} servo_id=ID --save"};
inline constexpr Text another_unit{"another unit", "別の機器"};
inline constexpr Text allocates{"node {} allocates node IDs",
                                "ノード {} がノード ID を割り当てています"};
inline constexpr Text commands_servos{"node {} commands servos",
                                      "ノード {} がサーボに動作指令を送信しています"};
inline constexpr Text says_armed{"node {} says armed", "ノード {} は ARM 状態です"};

} // namespace blactl::texts
