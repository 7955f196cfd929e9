#pragma once
// Messages of provision and ledger.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text line_pass{"PASS ", "合格 "};
inline constexpr Text line_fail{"FAIL ", "不合格"};
inline constexpr Text line_error{"ERROR", "再試行"};
inline constexpr Text line_skip{"SKIP ", "処理済"};
inline constexpr Text line_scrap{"SCRAP", "廃棄 "};

inline constexpr Text provision_question{
    "each servo {} that is connected gets {} settings, saved to its ROM, and is restarted; its "
    "shaft may move or let go.\n",
    "接続された {} に {} 項目を設定し、ROM に保存して再起動します。軸が動く場合や、保持力が"
    "なくなる場合があります。\n"};
inline constexpr Text provision_label_word{"--label reads from stdin only: {}",
                                           "--label は標準入力のみです: {}"};
inline constexpr Text provision_label_word_hint{"give --label -", "--label - と指定して下さい"};
inline constexpr Text provision_redo_reason{"--redo needs a reason for the record",
                                            "--redo には理由が必要です"};
inline constexpr Text provision_redo_reason_hint{"add --reason TEXT", "--reason で指定して下さい"};
inline constexpr Text provision_reason_alone{"--reason has no meaning without --redo",
                                             "--reason は --redo と併用して下さい"};
inline constexpr Text provision_reason_alone_hint{"leave it out", "外して下さい"};
inline constexpr Text provision_waits{"connect a servo", "サーボを接続して下さい"};
inline constexpr Text provision_label_waits{"scan a label", "ラベルを読み取って下さい"};
inline constexpr Text provision_asks{"identifying it", "サーボを確認しています"};
inline constexpr Text provision_works{"do not take it off", "外さないで下さい"};
inline constexpr Text provision_gone{"it is gone: connect it again",
                                     "サーボが外れました。もう一度接続して下さい"};
inline constexpr Text provision_without_record{
    "serial number {} was taken off before anything was written to it: it has no record",
    "製造番号 {} は書込み前に取り外されたため、記録がありません"};
inline constexpr Text provision_take_off{"take it off", "外して下さい"};
inline constexpr Text provision_idle{"no servo came within {} s",
                                     "{} 秒以内にサーボが接続されませんでした"};
inline constexpr Text provision_idle_hint{
    "{} of {} are done; run it again for the others",
    "{1} 台中 {0} 台を処理しました。続ける場合はもう一度実行して"
    "下さい"};
inline constexpr Text provision_labels_end{"the labels ended after {} of {} servos",
                                           "{1} 台中 {0} 台でラベルの入力が終わりました"};
inline constexpr Text provision_labels_end_hint{"give a line for each servo",
                                                "サーボごとに 1 行入力して下さい"};
inline constexpr Text provision_stopped{"{} servos failed one after the other (--stop-after)",
                                        "{} 台が連続して不合格になりました (--stop-after)"};
inline constexpr Text provision_trouble{"{}: trying again", "{}: 再試行します"};
inline constexpr Text provision_adapter{"{}: connect the adapter again",
                                        "{}: アダプターを接続し直して下さい"};
inline constexpr Text line_unit{"serial number {}: {}", "製造番号 {}: {}"};
inline constexpr Text provision_clock{"the clock of this machine is not synchronised",
                                      "時計が同期されていません"};

inline constexpr Text provision_no_logs{"no log can be kept in {}: {}",
                                        "{} にログを保存できません: {}"};
inline constexpr Text provision_no_logs_hint{"give a folder that can be written: --logs FOLDER",
                                             "書込み可能なフォルダを指定して下さい: --logs FOLDER"};
inline constexpr Text provision_takes_all{
    "provision takes whatever servo comes, as its recipe says: {} has no meaning",
    "provision は接続されたサーボをレシピに従って処理します ({} は指定できません)"};
inline constexpr Text provision_never_overwrites{
    "provision never saves to a servo that could not read its ROM: --overwrite-rom has no meaning",
    "provision は ROM を読み出せないサーボには保存しません (--overwrite-rom は指定できません)"};
inline constexpr Text provision_takes_all_hint{"leave it out", "外して下さい"};
inline constexpr Text ledger_copy_exists{"{} is there already", "{} は既に存在します"};
inline constexpr Text ledger_copy_exists_hint{"give a new name", "別の名前を指定して下さい"};
inline constexpr Text provision_logs_alone{"--logs and --record both want the frames",
                                           "--logs と --record は併用できません"};
inline constexpr Text provision_logs_alone_hint{"give one of them", "いずれか一方を指定して下さい"};
inline constexpr Text station_title{"station {}   recipe {}", "ステーション {}   レシピ {}"};
inline constexpr Text station_label{"label {}", "ラベル {}"};
inline constexpr Text station_totals{"pass {} fail {} error {} skip {}",
                                     "合格 {} 不合格 {} 再試行 {} 処理済 {}"};
inline constexpr Text station_owed{"must come back: {}", "再処理が必要: {}"};
inline constexpr Text station_yield{"first pass {}%", "直行率 {}%"};
inline constexpr Text deed_connect{"CONNECT A SERVO", "サーボを接続して下さい"};
inline constexpr Text deed_connect_again{"CONNECT IT AGAIN", "もう一度接続して下さい"};
inline constexpr Text deed_connect_one{"CONNECT ONE SERVO", "1 台だけ接続して下さい"};
inline constexpr Text deed_plug_in{"PLUG IN THE ADAPTER", "アダプターを接続して下さい"};
inline constexpr Text deed_mend{"CHECK THE CABLE", "ケーブルと電源を確認して下さい"};
inline constexpr Text deed_scan{"SCAN A LABEL", "ラベルを読み取って下さい"};
inline constexpr Text deed_scan_again{"SCAN IT AGAIN", "もう一度読み取って下さい"};
inline constexpr Text deed_leave{"WAIT", "そのままお待ち下さい"};
inline constexpr Text deed_hands_off{"DO NOT TAKE IT OFF", "外さないで下さい"};
inline constexpr Text deed_take_off{"TAKE IT OFF", "外して下さい"};
inline constexpr Text deed_take_all_off{"TAKE ALL OFF", "すべて外して下さい"};
inline constexpr Text deed_put_aside{"PUT IT ASIDE", "不合格品置き場へ"};
inline constexpr Text ledger_no_time{"{} is no time: {}", "{} の日時が不正です: {}"};
inline constexpr Text ledger_no_time_hint{"such as 2026-11-21T08:15:00Z",
                                          "例: 2026-11-21T08:15:00Z"};
inline constexpr Text ledger_alone{"{} stands alone, or with {}",
                                   "{} は単独で、または {} と指定して下さい"};
inline constexpr Text ledger_alone_hint{"leave out the other options",
                                        "他のオプションを外して下さい"};
inline constexpr Text ledger_scrap_reason{"--scrap needs a reason for the record",
                                          "--scrap には理由が必要です"};
inline constexpr Text ledger_scrap_question{
    "the servo {} is taken out, and its IDs by the recipe {} are given to the next one.\n",
    "サーボ {} を廃棄扱いとし、レシピ {} の ID を次のサーボに割り当てます。\n"};
inline constexpr Text ledger_copied{"the ledger is in {} now, the IDs that were given in {}",
                                    "製造記録を {} に、採番表を {} に保存しました"};
inline constexpr Text ledger_whole{"the ledger is complete\n", "製造記録に欠落はありません\n"};
inline constexpr Text counters_lost{
    "{}/counters.db is not there, which holds the IDs that were given: the same could be given "
    "twice",
    "採番表 {}/counters.db がありません。同じ ID を重複して割り当てる恐れがあります"};
inline constexpr Text counters_lost_hint{
    "copy the newest FILE.counters that `blactl ledger --backup FILE` made to {}/counters.db",
    "`blactl ledger --backup FILE` で作成した最新の FILE.counters を {}/counters.db に"
    "コピーして下さい"};
inline constexpr Text ledger_lost{
    "{}/ledger.db is not there, though counters.db holds IDs that were given",
    "採番表 counters.db はありますが、製造記録 {}/ledger.db がありません"};
inline constexpr Text ledger_lost_hint{
    "copy the newest FILE that `blactl ledger --backup FILE` made to {}/ledger.db",
    "`blactl ledger --backup FILE` で作成した最新の FILE を {}/ledger.db にコピーして下さい"};
inline constexpr Text ledger_hole{"station {}: the records {} to {} are missing\n",
                                  "ステーション {}: 記録 {}～{} がありません\n"};
inline constexpr Text ledger_begun{"station {}: {} was begun at {}, and has not ended\n",
                                   "ステーション {}: {} の処理 ({} 開始) が完了していません\n"};
inline constexpr Text ledger_unknown_unit{"a servo", "サーボ"};

} // namespace blactl::texts
