#pragma once
// Messages about logs: read by `replay:`, written by `--record`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text log_unreadable{"cannot read {}: {}", "{} を読み込めません: {}"};
inline constexpr Text log_unreadable_hint{
    "give a log of candump -l, blactl --record, Vector (ASC) or PEAK (TRC 1.1 to 2.1): -i "
    "replay:FILE",
    "candump -l、blactl --record、Vector (ASC)、PEAK (TRC 1.1～2.1) のログを指定して下さい: "
    "-i replay:FILE"};
inline constexpr Text log_cut_off{
    "{} is cut off: its gzip data ends too early; lines read before: {}",
    "{} は途中で切れています (gzip データが不完全)。読込み済み: {} 行"};
inline constexpr Text log_damaged{
    "{} is damaged: its gzip data is not valid; lines read before: {}",
    "{} は破損しています (gzip データが不正)。読込み済み: {} 行"};
inline constexpr Text log_damaged_hint{
    "the lines before that were used; check the file with gzip -t, or use the original log",
    "そこまでの内容は使用しました。gzip -t でファイルを確認し、元のログを使用して下さい"};
inline constexpr Text log_without_frames{
    "{} contains no frame in the format of candump, Vector ASC or PEAK TRC 1.1 to 2.1",
    "{} には candump、Vector ASC、PEAK TRC 1.1～2.1 いずれの形式のフレームもありません"};
inline constexpr Text standard_input{"standard input", "標準入力"};
inline constexpr Text log_takes_no_frames{"{} is a log: nothing can be sent to it",
                                          "{} はログのため送信できません"};
inline constexpr Text file_takes_no_frames{"{} is a file: nothing can be sent to it",
                                           "{} はファイルのため送信できません"};
inline constexpr Text log_takes_no_frames_hint{
    "give the interface that the servos are on: -i can0",
    "サーボを接続したインターフェースを指定して下さい: -i can0"};
inline constexpr Text record_failed{"recording to {} ended early: {}",
                                    "{} への記録が途中で終了しました: {}"};
inline constexpr Text record_failed_hint{
    "the recording is complete up to that point; free some space, or record elsewhere",
    "そこまでの記録は有効です。空き容量を確保するか、別の場所に記録して下さい"};
inline constexpr Text record_unopened{"cannot record to {}: {}", "{} に記録できません: {}"};
inline constexpr Text record_unopened_hint{"give a file that can be written: --record FILE",
                                           "書込み可能なファイルを指定して下さい: --record FILE"};

} // namespace blactl::texts
