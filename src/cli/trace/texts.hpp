#pragma once
// Messages of `blactl trace`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text unknown_type{"there is no data type '{}'", "データ型 '{}' はありません"};
inline constexpr Text unknown_type_hint{
    "give a name such as NodeStatus or param.GetSet, or a data type ID",
    "NodeStatus や param.GetSet などの名前、またはデータ型 ID を指定して下さい"};
inline constexpr Text trace_takes_node_ids{"-n {}: trace takes node IDs only",
                                           "-n {}: trace で指定できるのはノード ID のみです"};
inline constexpr Text trace_takes_node_ids_hint{"which servo has which ID: blactl scan",
                                                "どのサーボがどの ID かを調べるには: blactl scan"};
inline constexpr Text log_has_many_interfaces{
    "frames not decoded: {} (the log names more than {} interfaces)",
    "{} フレームをデコードしていません (ログのインターフェース数が {} を超えています)"};
inline constexpr Text trace_crc{"the CRC is wrong", "CRC が一致しません"};
inline constexpr Text trace_toggle{"a frame before this one was lost",
                                   "これより前のフレームが失われました"};
inline constexpr Text trace_missing_start{"its first frame was not heard",
                                          "先頭のフレームを受信していません"};
inline constexpr Text trace_transfer_id{
    "repeated, or begun before the end of the last one",
    "転送 ID が重複しているか、前の転送の終了前に開始されました"};
inline constexpr Text trace_truncated{"a frame is too short for its place, or the payload too long",
                                      "フレームが短すぎるか、ペイロードが長すぎます"};
inline constexpr Text trace_timeout{"the rest did not come within 2 s",
                                    "残りのフレームが 2 秒以内に届きませんでした"};
inline constexpr Text trace_short{"the payload is too short for its type",
                                  "ペイロードがデータ型より短くなっています"};
inline constexpr Text trace_no_value{"has no value", "値なし"};
inline constexpr Text trace_bla_angle{"(BLA servo: {} deg)", "(BLA サーボの場合 {} deg)"};
inline constexpr Text trace_crc_unchecked{"(CRC not checked)", "(CRC 未確認)"};
inline constexpr Text column_type{"TYPE", "データ型"};
inline constexpr Text column_transfers{"COUNT", "転送数"};
inline constexpr Text column_per_second{"PER S", "毎秒"};
inline constexpr Text column_period_ms{"MEAN ms", "周期 ms"};
inline constexpr Text column_range_ms{"MIN-MAX ms", "範囲 ms"};
inline constexpr Text column_jitter{"JITTER", "ジッタ"};
inline constexpr Text column_lost{"LOST", "欠落"};
inline constexpr Text column_errors{"ERRORS", "エラー数"};
inline constexpr Text column_load{"LOAD %", "負荷 %"};
inline constexpr Text trace_load{
    "{}: frames: {} in {} s, load {}, busiest second {}, last second {}\n",
    "{}: {} フレーム / {} 秒、バス負荷 {}、最大 (1 秒間) {}、直近 1 秒 {}\n"};
inline constexpr Text trace_no_frames{"no frames\n", "フレームなし\n"};
inline constexpr Text trace_span{"from {} to {}\n", "{} から {} まで\n"};
inline constexpr Text trace_errors_by_kind{"errors: {}\n", "エラー: {}\n"};
inline constexpr Text trace_jumps{
    "+: the transfer IDs also jumped so that losses cannot be counted: a restart, a longer "
    "silence, "
    "or "
    "two senders with one node ID\n",
    "+: 数を判定できない転送 ID の飛びもあります (再起動、長い中断、ノード ID の重複)\n"};

} // namespace blactl::texts
