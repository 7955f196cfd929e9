#pragma once
// Messages of a production line: of its station, and of units that are taken out.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text station_was_killed{"the station ended while it worked on this unit",
                                         "この個体の処理中にステーションが終了しました"};
inline constexpr Text station_several{"several servos are connected",
                                      "サーボが複数接続されています"};
inline constexpr Text station_several_hint{"take all of them off, then connect one",
                                           "すべて取り外し、1 台だけ接続して下さい"};
inline constexpr Text station_pulled{"the servo was taken off too early",
                                     "処理の途中でサーボが取り外されました"};
inline constexpr Text station_pulled_hint{
    "connect it again, and leave it until the result is shown",
    "もう一度接続し、結果が表示されるまで外さないで下さい"};
inline constexpr Text station_other_serial{
    "a unit with this unique ID and the serial number {} was here before",
    "固有 ID が同じで製造番号が {} の個体を処理済みです"};
inline constexpr Text station_ids_freed{"its IDs were freed while it was at work",
                                        "処理中に ID が解放されました"};
inline constexpr Text station_attempts{"this unit has failed {} times",
                                       "この個体は {} 回不合格になりました"};
inline constexpr Text station_rom_unread{"the servo could not read its ROM at this start either",
                                         "再起動後も ROM を読み出せません"};
inline constexpr Text station_rom_unread_hint{
    "take it off and connect it again: its next start may read it; else put it aside, and write "
    "its "
    "ROM anew away from the line: blactl erase -n {} --save",
    "一度取り外して接続し直すと読み出せる場合があります。読み出せなければラインから外し、ライン外で"
    " "
    "ROM を書き直して下さい: blactl erase -n {} --save"};
inline constexpr Text counters_behind{
    "the table of assigned IDs does not know {} servos that have passed by the recipe {} (the "
    "first: "
    "unique ID {}): their IDs would be given twice",
    "レシピ {1} で合格した {0} 台のサーボ (先頭: 固有 ID {2}) が採番表にありません。"
    "同じ ID を重複して割り当てる恐れがあります"};
inline constexpr Text counters_behind_hint{
    "copy the newest FILE.counters that `blactl ledger --backup FILE` made to counters.db in the "
    "state folder, or give the recipe a new name, and counters that begin after the IDs in "
    "`blactl ledger`",
    "`blactl ledger --backup FILE` で作成した最新の FILE.counters を状態フォルダーの counters.db に"
    "コピーするか、レシピの名前を変え、`blactl ledger` に"
    "ある ID の次からカウンターを始めて下さい"};
inline constexpr Text own_id_is_given{
    "--local-node-id {}: the recipe gives servos the node ID {}, and the station would have the "
    "same",
    "--local-node-id {}: レシピがサーボに設定するノード ID {} と重複します"};
inline constexpr Text own_id_is_given_hint{
    "leave out --local-node-id (the station is 127 or 126 then), or give another one than {}",
    "--local-node-id を外すか (127 か 126 になります)、{} 以外の ID を指定して下さい"};
inline constexpr Text station_unproven{"it is not proven what the servo holds now",
                                       "サーボの現在の設定を確認できませんでした"};

inline constexpr Text scrap_at_work{"the station {} works on this servo",
                                    "ステーション {} がこのサーボを処理中です"};
inline constexpr Text scrap_at_work_hint{"wait until it has ended", "処理の終了を待って下さい"};
inline constexpr Text scrap_of_twin{
    "serial number {} was given no IDs: those of its unique ID are those of serial number {}",
    "シリアル番号 {} に ID は割り当てていません。この固有 ID の ID はシリアル番号 {} のものです"};
inline constexpr Text scrap_of_twin_hint{"its record stays; nothing has to be freed",
                                         "記録はそのままで、解放する ID はありません"};
inline constexpr Text scrap_no_record{"no record has the record_id {}",
                                      "record_id {} の記録がありません"};
inline constexpr Text scrap_no_record_hint{"find it with blactl ledger --serial N --json",
                                           "blactl ledger --serial N --json で確認して下さい"};
inline constexpr Text scrap_no_unit{"that record names no unit",
                                    "その記録には個体の情報がありません"};

} // namespace blactl::texts
