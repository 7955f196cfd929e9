#pragma once
// The catalogue of `blactl trace`.

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
inline constexpr Text trace_crc_unchecked{"(CRC not checked)", "(CRC 未確認)"};
inline constexpr Text column_interface{"INTERFACE", "インターフェース"};
inline constexpr Text column_kind{"KIND", "種別"};
inline constexpr Text column_type{"TYPE", "データ型"};
inline constexpr Text column_transfers{"TRANSFERS", "転送数"};
inline constexpr Text column_per_second{"PER SECOND", "毎秒"};
inline constexpr Text column_frames{"FRAMES", "フレーム数"};
inline constexpr Text column_bytes{"BYTES", "バイト数"};
inline constexpr Text column_errors{"ERRORS", "エラー数"};
inline constexpr Text column_load{"LOAD %", "負荷 %"};
inline constexpr Text trace_load{"{}: frames: {} in {} s, {} % of 1 Mbit/s\n",
                                 "{}: {} フレーム / {} 秒、バス負荷 {} % (1 Mbit/s)\n"};

} // namespace blactl::texts
