#pragma once
// The catalogue of the floor fleet.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text no_answer{"node {}: no answer to {}", "ノード {}: {} に応答がありません"};
inline constexpr Text no_answer_hint{
    "check supply and cable, or ask more patiently with --timeout and --retries",
    "電源と配線を確認するか、--timeout と --retries で待ち時間を延ばしてください",
};
inline constexpr Text not_sent{"node {}: the request for {} did not leave this machine",
                               "ノード {}: {} の要求を送信できませんでした"};
inline constexpr Text cancelled{"node {}: {} was not finished", "ノード {}: {} は完了していません"};
inline constexpr Text not_recorded{"node {}: not in the recording: {}",
                                   "ノード {}: 記録にありません: {}"};
inline constexpr Text not_recorded_hint{
    "what a servo says counts until it restarts; record all of it: blactl get --all --record FILE",
    "サーボの応答は再起動までの分だけが有効です。すべて記録するには: "
    "blactl get --all --record FILE"};
inline constexpr Text identity_not_recorded{
    "node {} is in the recording, but not what it is",
    "ノード {} は記録にありますが、機種などの情報がありません"};
inline constexpr Text node_not_recorded{"node {} is not in the recording",
                                        "ノード {} は記録にありません"};
inline constexpr Text register_refused{"node {}: the servo refuses {}",
                                       "ノード {}: サーボが {} を拒否しました"};
inline constexpr Text register_refused_hint{
    "the firmware of this servo may lack this parameter: blactl get firmware_version -n {}",
    "このサーボのファームウェアには無いパラメータかもしれません: blactl get firmware_version -n {}",
};
inline constexpr Text nobody_acknowledges{
    "{}: nobody acknowledges our frames",
    "{}: 送信フレームに対する ACK がありません",
};
inline constexpr Text nobody_acknowledges_hint{
    "is a servo powered and connected, the bus terminated, and the bit rate 1000000?",
    "サーボの電源と接続、終端抵抗、ビットレート 1000000 を確認してください",
};
inline constexpr Text bus_is_off{"{}: the controller is bus-off",
                                 "{}: コントローラがバスオフ状態です"};
inline constexpr Text bus_is_off_hint{
    "check wiring and bit rate, then: sudo ip link set {} down; sudo ip link set {} up",
    "配線とビットレートを確認後: sudo ip link set {} down; sudo ip link set {} up",
};
inline constexpr Text own_id_in_use{"node ID {} is used by another node on {}",
                                    "ノード ID {} は {} 上の別のノードが使用しています"};
inline constexpr Text own_id_in_use_hint{
    "give a free node ID: --local-node-id ID",
    "空いているノード ID を指定してください: --local-node-id ID"};
inline constexpr Text interrupted{"interrupted", "中断されました"};
inline constexpr Text unreadable_frames{
    "{} messages that were no frames of classic CAN were passed over (CAN FD, or damaged)",
    "Classic CAN フレームではないメッセージ {} 件を無視しました (CAN FD または破損)"};
inline constexpr Text frames_lost{
    "{} frames were lost because they came faster than they could be read",
    "読み出しが間に合わず {} フレームを失いました",
};

inline constexpr Text node_not_found{"node {} is not on the bus", "ノード {} はバス上にありません"};
inline constexpr Text node_not_found_hint{"see who is there: blactl scan",
                                          "接続中のノードを確認: blactl scan"};
inline constexpr Text node_mute{"node {} is on the bus but does not answer",
                                "ノード {} はバス上にありますが応答しません"};
inline constexpr Text not_a_servo{"node {} ({}) is not a BLA servo",
                                  "ノード {} ({}) は BLA サーボではありません"};
inline constexpr Text no_servo_found{"no BLA servo is on the bus",
                                     "バス上に BLA サーボがありません"};
inline constexpr Text no_servo_found_hint{
    "a servo without a node ID shows in: blactl scan",
    "ノード ID の無いサーボは blactl scan で確認できます",
};
inline constexpr Text nothing_matches{"no servo on the bus matches {}",
                                      "{} に該当するサーボはバス上にありません"};
inline constexpr Text restarted_meanwhile{
    "node {} restarted and is another servo now: nothing more was written to it",
    "ノード {} は再起動後に別のサーボになりました。以後は書き込んでいません",
};
inline constexpr Text restarts_again{
    "node {} restarts again and again while it is written to",
    "ノード {} は書き込み中に何度も再起動しています",
};
inline constexpr Text restarts_again_hint{
    "check its supply voltage",
    "電源電圧を確認してください",
};
inline constexpr Text about_node{"node {}: {}", "ノード {}: {}"};
inline constexpr Text write_refused{"node {}: {}={}: the servo refused it and still holds {}",
                                    "ノード {}: {}={}: サーボが拒否しました。値は {} のままです"};
inline constexpr Text write_mismatch{"node {}: {}={}: the servo holds {} instead",
                                     "ノード {}: {}={}: サーボの値は {} になっています"};

inline constexpr Text not_taken_hint{
    "is it the model that it says it is? compare its label with: blactl get -n {} --group product",
    "機種が正しいか銘板と照合してください: blactl get -n {} --group product"};

inline constexpr Text doubled_node_id{"two nodes share node ID {}",
                                      "ノード ID {} が 2 台で重複しています"};
inline constexpr Text doubled_static_id{"nodes {} have the same static node ID {}",
                                        "ノード {} の UAVCAN ノード ID 設定が {} で重複しています"};
inline constexpr Text doubled_servo_id{"nodes {} have the same servo ID {}",
                                       "ノード {} のサーボ ID が {} で重複しています"};

inline constexpr Text doubled_target{"node ID {} is used by two nodes: nothing is written to it",
                                     "ノード ID {} が重複しているため書き込みません"};
inline constexpr Text doubled_target_hint{"connect one of them alone and give it another ID",
                                          "一台ずつ接続して別の ID を設定してください"};
inline constexpr Text armed{"node {} says that the vehicle is armed: nothing is written",
                            "ノード {} が ARM 状態を通知しているため書き込みません"};
inline constexpr Text armed_hint{"disarm it first", "先に DISARM してください"};
inline constexpr Text driven{"node {} commands node {}: not while it does",
                             "ノード {} がノード {} に動作指令を送信中のため実行しません"};
inline constexpr Text driven_hint{"stop it, or add --while-driven",
                                  "停止させるか、--while-driven を付けてください"};
inline constexpr Text node_id_in_use{"static_node_id={} is in use by another node",
                                     "static_node_id={} は別のノードが使用中です"};
inline constexpr Text node_id_in_use_hint{"see which IDs are taken: blactl scan",
                                          "使用中の ID を確認: blactl scan"};

inline constexpr Text defaults_unknown{
    "node {}: the model is not known well enough to tell the default of {}",
    "ノード {}: 機種を特定できないため、{} の初期値が不明です",
};
inline constexpr Text defaults_unknown_hint{
    "see what it says of itself: blactl get --group product",
    "機種情報を確認: blactl get --group product",
};
inline constexpr Text holds_instead{"{} is {} instead of {}", "{} は {} (期待値 {})"};
inline constexpr Text rom_unreadable{
    "node {} could not read its ROM at its start and holds initial values",
    "ノード {}: 起動時に ROM のデータを読み出せず、初期値で動作しています"};
inline constexpr Text rom_unreadable_hint{
    "was the supply cut while it saved? write its values again, then: blactl save -n {}",
    "保存中に電源が切れた可能性があります。値を書き直してから blactl save -n {} "
    "を実行してください"};
inline constexpr Text not_saved{"node {}: ROM was not written",
                                "ノード {}: ROM に保存していません"};
inline constexpr Text values_differ{"node {}: {}", "ノード {}: {}"};
inline constexpr Text not_begun{"node {}: interrupted before anything was sent",
                                "ノード {}: 送信前に中断されました"};
inline constexpr Text another_servo{"node {} is another servo now: nothing was sent",
                                    "ノード {} は別のサーボに替わったため、送信していません"};
inline constexpr Text opcode_refused{"node {} refused {}", "ノード {} が {} を拒否しました"};
inline constexpr Text opcode_ignored{
    "node {} neither answered {} nor carried it out, although it lives",
    "ノード {} は動作していますが、{} に応答せず実行もしませんでした",
};
inline constexpr Text did_not_restart{"node {} confirmed {} and then did not restart",
                                      "ノード {} は {} に応答しましたが再起動しませんでした"};
inline constexpr Text opcode_refused_hint{
    "does it tell why? blactl get -n {} --group fault",
    "原因を異常情報で確認してください: blactl get -n {} --group fault"};
inline constexpr Text restart_not_waited_for{
    "node {} was sent RestartNode, and was not waited for until it was back",
    "ノード {}: RestartNode 送信後、復帰を確認せずに終了しました"};
inline constexpr Text save_not_waited_for{
    "node {} was sent SAVE and was not waited for: what its ROM holds is not known",
    "ノード {}: SAVE 送信後、復帰を確認せずに終了しました。ROM の内容は不明です"};
inline constexpr Text not_waited_for_hint{"is it back? blactl wait -n {}",
                                          "復帰の確認: blactl wait -n {}"};
inline constexpr Text rom_differs_hint{
    "RAM had the right values, ROM did not take them: write and save them again; if that does not "
    "help, the ROM is faulty",
    "RAM の値は正しく、ROM に保存されていません。書込みと保存を再度行い、改善しなければ ROM "
    "の異常です"};
inline constexpr Text saved_not_back{
    "node {} confirmed SAVE and did not come back: what its ROM holds is not known",
    "ノード {} は SAVE に応答後、復帰しません。ROM の内容は不明です",
};
inline constexpr Text restarted_not_back{"node {} confirmed the restart and did not come back",
                                         "ノード {} は再起動に応答後、復帰しません"};
inline constexpr Text unconfirmed_not_back{
    "node {} did not answer {} and is gone: whether it was carried out is not known",
    "ノード {} は {} に応答せず、通信も途絶えました。実行されたかどうかは不明です",
};
inline constexpr Text not_back_hint{
    "check its supply and cable, power it off and on, then: blactl scan",
    "電源と配線を確認し、電源を入れ直してから blactl scan を実行してください",
};
inline constexpr Text waits_for_id_hint{
    "it asks for a node ID and nobody gives it one: is another allocator stopped? then power it "
    "off "
    "and on",
    "ノード ID "
    "の割当てを要求していますが、割当てるノードがありません。割当て元を確認し、電源を入れ直してくだ"
    "さい",
};
inline constexpr Text unchanged_no_more{
    "node {} restarted: {} may have another value now",
    "ノード {} が再起動したため、{} の値が変わっている可能性があります",
};
inline constexpr Text restarted_before_write{
    "node {} restarted after it was read: nothing was written",
    "ノード {} が読出し後に再起動したため、書き込んでいません",
};
inline constexpr Text run_again_hint{"run the command again",
                                     "同じコマンドをもう一度実行してください"};
inline constexpr Text node_id_is_ours{"static_node_id={} is the node ID of this process",
                                      "static_node_id={} はこのプロセスのノード ID です"};
inline constexpr Text bad_target{"-n {}: not a node ID, range or selector",
                                 "-n {}: ノード ID、範囲、セレクタのいずれでもありません"};
inline constexpr Text bad_target_hint{
    "for example -n 12, -n 10-14,20, -n all, -n serial:240900558, -n model:BLA21-12U",
    "例: -n 12, -n 10-14,20, -n all, -n serial:240900558, -n model:BLA21-12U",
};

} // namespace blactl::texts
