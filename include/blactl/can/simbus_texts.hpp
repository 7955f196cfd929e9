#pragma once
// Messages of the client of the simulated bus.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text simbus_absent{"no simulator serves {}: {}",
                                    "{} でシミュレータが動いていません: {}"};
inline constexpr Text simbus_absent_hint{"start `blactl sim` in another terminal",
                                         "別の端末で `blactl sim` を実行して下さい"};
inline constexpr Text simbus_gone{"the simulator of {} has ended",
                                  "{} のシミュレータが終了しました"};
inline constexpr Text simbus_off_hint{
    "it is simulated, by the event or the order `clients bus_off`; run the command again",
    "シミュレーション (イベントまたは指示 `clients bus_off`) です。もう一度実行して下さい"};
inline constexpr Text simbus_version{"the simulator of {} belongs to another version of blactl",
                                     "{} のシミュレータは別のバージョンの blactl です"};
inline constexpr Text simbus_version_hint{
    "stop it with Ctrl-C and start `blactl sim` again",
    "Ctrl-C で停止し、もう一度 `blactl sim` を実行して下さい"};
inline constexpr Text simbus_silent{"{} does not answer as a simulator would",
                                    "{} はシミュレータとして応答しません"};
inline constexpr Text simbus_foreign_folder{
    "{} is not a folder of this user: a socket there is not trusted",
    "{} はこのユーザーのフォルダではないため、接続しません"};
inline constexpr Text simbus_foreign_folder_hint{
    "remove it, or set XDG_RUNTIME_DIR to a folder of your own",
    "削除するか、XDG_RUNTIME_DIR に自分のフォルダを設定して下さい"};
inline constexpr Text simbus_path_too_long{"{} is too long for a socket: at most {} bytes",
                                           "{} はソケットのパスとして長すぎます(最大 {} バイト)"};

} // namespace blactl::texts
