#pragma once
// Messages of `blactl doctor`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text doctor_interface{"interface", "インターフェース"};
inline constexpr Text doctor_bus{"bus", "バス"};
inline constexpr Text doctor_nodes{"nodes", "ノード"};
inline constexpr Text doctor_up{"up", "動作中"};
inline constexpr Text doctor_down{"down", "停止中"};
inline constexpr Text doctor_bit_timing{"{} bit/s, sample point {}.{} %",
                                        "{} bit/s、サンプルポイント {}.{} %"};
inline constexpr Text doctor_restart_after{"restart-ms {}", "restart-ms {}"};
inline constexpr Text doctor_queue{"queue {} frames", "送信キュー {} フレーム"};
inline constexpr Text doctor_errors{"errors {} sending, {} receiving", "エラー 送信 {}、受信 {}"};
inline constexpr Text doctor_adapter_version{"version {}", "バージョン {}"};
inline constexpr Text doctor_adapter_serial_number{"serial number {}", "シリアル番号 {}"};
inline constexpr Text doctor_adapter_status{"status {}", "ステータス {}"};
inline constexpr Text doctor_traffic{"frames: {} in {} s, {}.{} % busy",
                                     "{} フレーム / {} 秒、負荷 {}.{} %"};
inline constexpr Text doctor_no_traffic{"no frames", "フレームなし"};
inline constexpr Text doctor_frames{"frames: {}", "{} フレーム"};
inline constexpr Text doctor_senders{"frames/s by node: {}", "ノード別フレーム/秒: {}"};
inline constexpr Text doctor_found{"servos: {}, other nodes: {}", "サーボ {} 台、その他 {} ノード"};
inline constexpr Text doctor_found_named{"looked at: {}, others on the bus: {}",
                                         "対象 {} 台、その他 {} ノード"};
inline constexpr Text doctor_commanders{"servos are commanded by: {}", "動作指令元: {}"};
inline constexpr Text doctor_tools{"tools (by their ID): {}", "ツール (ID による判定): {}"};
inline constexpr Text doctor_read_none{
    "none of the servos of -n was read: why one does not move is not judged",
    "-n のサーボのレジスタを読み出していないため、動作しない原因は診断していません"};
inline constexpr Text doctor_not_judged{"not judged", "未判定"};
inline constexpr Text doctor_commands_unjudged{
    "node {}: whether anybody commands it: {} s of the bus were heard, {} s are needed",
    "ノード {}: 動作指令の有無 (受信時間 {} 秒、{} 秒以上必要)"};
inline constexpr Text doctor_commands_untimed{
    "node {}: whether anybody commands it: that needs a recording with time stamps",
    "ノード {}: 動作指令の有無 (時刻付きの記録が必要)"};
inline constexpr Text doctor_nothing_else{"nothing is wrong in the rest, as far as it was heard\n",
                                          "その他、受信した範囲で問題は見つかりませんでした\n"};
inline constexpr Text doctor_nothing{"nothing is wrong, as far as it was heard\n",
                                     "受信した範囲で問題は見つかりませんでした\n"};
inline constexpr Text doctor_fix{"fix: {}", "対処: {}"};
inline constexpr Text doctor_fixed{"fixed", "修正済み"};
inline constexpr Text doctor_fix_question{"{} is to be set up:\n", "{} を設定します:\n"};
inline constexpr Text doctor_fix_as{"as does: {}\n", "次のコマンドに相当: {}\n"};
inline constexpr Text doctor_fix_interrupts{
    "it goes down for a moment: other programs that use {} may end\n",
    "一時的に停止するため、{} を使用中の他のプログラムが終了することがあります\n"};
inline constexpr Text doctor_fix_nowhere{
    "--fix sets up CAN interfaces of this machine only; {} is none, and nothing was changed",
    "--fix の対象はこのマシンの CAN インターフェースのみです。{} には何も設定していません"};
inline constexpr Text doctor_written{
    "report written to {}: it can be read, and answers -i replay:{}",
    "{} に診断結果を保存しました (-i replay:{} でも参照できます)"};
inline constexpr Text doctor_listens{"listening for {} s", "{} 秒間受信しています"};
inline constexpr Text doctor_report_and_record{
    "--report and --record do not go together: the report holds all frames",
    "--report と --record は同時に指定できません (診断結果に全フレームが含まれます)"};
inline constexpr Text doctor_report_and_record_hint{"leave one of them out",
                                                    "どちらか一方を指定して下さい"};
inline constexpr Text doctor_report_head{"report of blactl {}, {}, interface {}",
                                         "blactl {} 診断結果、{}、インターフェース {}"};
inline constexpr Text doctor_report_faults{"faults", "障害・警告・通知"};
inline constexpr Text doctor_report_parameters{"parameters", "パラメータ"};
inline constexpr Text doctor_report_allocations{"allocation table", "割当て表"};
inline constexpr Text doctor_report_traffic{"traffic, as candump -L writes it",
                                            "通信ログ (candump -L 形式)"};
inline constexpr Text doctor_to_stdout_no{"--report {}: a file is needed",
                                          "--report {}: ファイルを指定して下さい"};

} // namespace blactl::texts
