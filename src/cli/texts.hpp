#pragma once
// Messages of the floor cli; commands with many messages have their own catalogue.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text stdout_failed{"cannot write to standard output: {}",
                                    "標準出力に書き込めません: {}"};
inline constexpr Text stdout_failed_hint{"free some space, or send the output elsewhere",
                                         "空き容量を確保するか、出力先を変更して下さい"};

inline constexpr Text own_fault{"blactl itself failed: {}", "blactl の内部エラーです: {}"};
inline constexpr Text own_fault_hint{
    "this should not happen: run it again with -v, and report what it says",
    "本来起こらないエラーです。-v を付けて再実行し、表示された内容を報告して下さい"};
inline constexpr Text unknown_exception{"an unknown exception", "不明な例外"};

inline constexpr Text unknown_command{"there is no command '{}'", "コマンド '{}' はありません"};
inline constexpr Text no_command{"no command given", "コマンドが指定されていません"};
inline constexpr Text unexpected_argument{"not expected: {}", "不要な引数です: {}"};
inline constexpr Text unknown_option{"unknown option: {}", "不明なオプションです: {}"};
inline constexpr Text not_understood{"{}", "コマンドラインを解釈できません: {}"};
inline constexpr Text empty_value{"{}: the value is empty", "{}: 値が空です"};
inline constexpr Text takes_one_value{"{} needs a value", "{} の値がありません"};
inline constexpr Text takes_no_value{"{} takes no value", "{} に値は指定できません"};
inline constexpr Text argument_missing{"{} is missing", "{} がありません"};

// --help
inline constexpr Text help_program{
    "blactl configures and diagnoses Futaba BLA servos over DroneCAN.",
    "blactl: 双葉電子工業 BLA サーボを DroneCAN で設定・診断します。"};
inline constexpr Text help_usage{"Usage: {}", "使い方: {}"};
inline constexpr Text help_commands{"Commands:", "コマンド:"};
inline constexpr Text help_arguments{"Arguments:", "引数:"};
inline constexpr Text help_options{"Options:", "オプション:"};
inline constexpr Text help_shared{"Options of all commands, before or after the command:",
                                  "全コマンド共通のオプション (コマンドの前後どちらでも可):"};
inline constexpr Text help_exit_status{
    "Exit status: 0 done, 1 failure, 2 refused before any write, 3 interface, 4 no answer, 5 the "
    "servo refused, 6 mixed, 7 not confirmed, 8 found something, 9 conflict.",
    "終了ステータス: 0=完了、1=失敗、2=書込み前に拒否、3=インターフェース、4=応答なし、"
    "5=サーボが拒否、6=サーボごとに異なる結果、7=同意なし、8=検出あり、9=競合。"};
inline constexpr Text help_writes{"Without -n there must be just one servo on the bus.",
                                  "-n を省略できるのは、バス上のサーボが 1 台だけの場合です。"};
inline constexpr Text help_from_history{"Without -n: the servos that the last command changed.",
                                        "-n 省略時の対象は、直前のコマンドで変更したサーボです。"};
inline constexpr Text help_for_newcomer{
    "Without -n: the one servo that no entry of FILE means, also one that waits for a node ID.",
    "-n 省略時の対象は、FILE にエントリのない 1 台です (ノード ID 割当て待ちを含む)。"};
inline constexpr Text help_from_file{"FILE says which servos are meant; -n narrows it down.",
                                     "対象サーボは FILE で決まります。-n で絞り込めます。"};
inline constexpr Text help_logs{"Also answers from a recording, -i {}.",
                                "記録 (-i {}) からも読出しできます。"};
inline constexpr Text help_recordings{
    "Also answers from a recording, -i {}, and from a fleet file, -i {}.",
    "記録 (-i {})、フリートファイル (-i {}) からも読出しできます。"};
inline constexpr Text help_no_bus{
    "It uses no bus: options about the bus, such as -i and --timeout, do nothing here.",
    "バスは使用しません。-i や --timeout などバスに関するオプションは無視されます。"};
inline constexpr Text help_see_shared{"Options of all commands: see blactl --help.",
                                      "共通オプションは blactl --help を参照して下さい。"};

inline constexpr Text see_help{"see blactl --help", "blactl --help を参照して下さい"};
inline constexpr Text see_command_help{"see blactl {} --help", "blactl {} --help を参照して下さい"};
inline constexpr Text bad_seconds{"{} {}: not a number of seconds between {} and {}",
                                  "{} {}: {}～{} 秒の範囲の数値ではありません"};
inline constexpr Text bad_rate{"{} {}: not a number of Hz between {} and {}",
                               "{} {}: {}～{} Hz の範囲の数値ではありません"};
inline constexpr Text bad_number{"{} {}: not a whole number between {} and {}",
                                 "{} {}: {}～{} の整数ではありません"};
inline constexpr Text bad_word{"{} {}: not one of {}", "{} {}: {} のいずれでもありません"};
inline constexpr Text json_and_csv{"--json and --csv exclude each other",
                                   "--json と --csv は同時に指定できません"};
inline constexpr Text no_csv{"{} has no CSV output", "{} は CSV 出力に対応していません"};
inline constexpr Text no_csv_hint{"use --json instead", "代わりに --json を使って下さい"};
inline constexpr Text record_needs_file{"--record needs a file: standard output is for data",
                                        "--record にはファイルを指定して下さい "
                                        "(標準出力はデータ用です)"};
inline constexpr Text nothing_to_record{"{} has no session that could be recorded",
                                        "{} には記録できるセッションがありません"};
inline constexpr Text no_nodes{"{} does not contact servos: it takes no --node",
                               "{} はサーボに問い合わせないため、--node は指定できません"};
inline constexpr Text records_over_file{"--record {}: that is the file of {}",
                                        "--record {}: {} に指定したファイルと同じです"};
inline constexpr Text records_over_file_hint{"type another file for --record",
                                             "--record には別のファイルを指定して下さい"};
inline constexpr Text log_over_state{"{} {}: blactl keeps its own records there",
                                     "{} {}: blactl が自身の記録を保存するファイルです"};
inline constexpr Text log_over_state_hint{"type another file", "別のファイルを指定して下さい"};
inline constexpr Text log_over_other{"{} {}: that file is there, and is no log",
                                     "{} {}: 既存のファイルで、ログではありません"};
inline constexpr Text events_over_other{"{} {}: that file is there, and has no events of blactl",
                                        "{} {}: 既存のファイルで、blactl のイベントではありません"};
inline constexpr Text facts_over_other{"{} {}: that file is there, and is no facts file",
                                       "{} {}: 既存のファイルで、実測ファイルではありません"};
inline constexpr Text drawing_over_other{"{} {}: that file is there, and is no drawing",
                                         "{} {}: 既存のファイルで、図ではありません"};
inline constexpr Text log_over_other_hint{
    "type another file, or remove that one first",
    "別のファイルを指定するか、先にそのファイルを削除して下さい"};
inline constexpr Text records_itself{"--record {}: that is the log being read",
                                     "--record {}: 読込み中のログと同じファイルです"};
inline constexpr Text lines_passed_over{
    "{}: lines skipped because they are not frames: {}, the first is line {}",
    "{}: フレームではない {} 行を無視しました (最初は {} 行目)"};
inline constexpr Text only_one_servo{"{} takes one servo, not {}",
                                     "{} の対象は 1 台だけです ({} 台指定)"};
inline constexpr Text only_one_servo_hint{"name it: blactl {} -n {}",
                                          "対象を指定: blactl {} -n {}"};
inline constexpr Text listen_only_refused{
    "{} must send, which --listen-only forbids",
    "{} は送信が必要なため --listen-only では実行できません",
};
inline constexpr Text listen_only_hint{"leave --listen-only out", "--listen-only を外して下さい"};

inline constexpr Text bad_interface{"-i {}: no such kind of interface",
                                    "-i {}: この種類のインターフェースはありません"};
inline constexpr Text interface_name_missing{"-i {}: the name of the interface is missing",
                                             "-i {}: インターフェースの名前がありません"};
inline constexpr Text interface_meant{"-i {}: the kind of interface is missing",
                                      "-i {}: インターフェースの種類がありません"};
inline constexpr Text interface_meant_hint{"did you mean -i {}?", "もしかして: -i {}"};
inline constexpr Text bad_interface_hint{
    "for example {}",
    "例: {}",
};
inline constexpr Text slcan_bad_name{"-i slcan:{}: {}", "-i slcan:{}: {}"};
inline constexpr Text slcan_no_device{"the device is missing", "デバイスの指定がありません"};
inline constexpr Text slcan_bad_baud{"baud {}: not a rate of serial ports up to 4000000",
                                     "baud {}: シリアルポートの速度 (4000000 以下) ではありません"};
inline constexpr Text slcan_unknown_key{"there is no option '{}'", "オプション '{}' はありません"};
inline constexpr Text slcan_doubled_key{"{} is given twice", "{} が 2 回指定されています"};
inline constexpr Text slcan_name_hint{
    "-i \"slcan:DEV?baud=1000000&open=plain,s8&ack=auto,none&gap=MS\" with one of the words each, "
    "every option may be left out; for example -i \"slcan:/dev/ttyUSB0?open=plain\"",
    "-i \"slcan:DEV?baud=1000000&open=plain,s8&ack=auto,none&gap=MS\" (語はそれぞれ一つ選択、"
    "各オプションは省略可能)。例: -i \"slcan:/dev/ttyUSB0?open=plain\"",
};
inline constexpr Text bad_mcast{"-i mcast:{}: not of the form mcast:N or mcast:N?if=IFACE",
                                "-i mcast:{}: mcast:N または mcast:N?if=IFACE の形ではありません"};
inline constexpr Text bad_mcast_hint{
    "N is from 0 to 255, IFACE a network interface, for example -i mcast:0?if=lo",
    "N は 0～255、IFACE はネットワークインターフェースです (例: -i mcast:0?if=lo)",
};
inline constexpr Text mcast_chosen{"using {} (another interface: ?if=IFACE)",
                                   "{} を使います (変更するには ?if=IFACE)"};
inline constexpr Text no_interface{"no CAN interface is up",
                                   "起動している CAN インターフェースがありません"};
inline constexpr Text several_interfaces{"several CAN interfaces are up: {}",
                                         "起動している CAN インターフェースが複数あります: {}"};
inline constexpr Text several_interfaces_hint{"choose one: -i {}", "一つ選んで下さい: -i {}"};
inline constexpr Text no_interface_hint{
    "for example: sudo ip link set can0 up type can bitrate 1000000 sample-point 0.875   "
    "(without hardware: -i sim:)",
    "例: sudo ip link set can0 up type can bitrate 1000000 sample-point 0.875   "
    "(ハードウェアが無い場合: -i sim:)",
};
inline constexpr Text interface_is_down{"{} is there but down: {}", "{} は停止しています: {}"};
inline constexpr Text sim_is_private{
    "no simulator is running: using a private fresh one (start one with: blactl sim)",
    "シミュレータが動作していないため、専用の新しいものを使います (起動: blactl sim)",
};
inline constexpr Text profile_replaced{"{} replaces the built-in profile",
                                       "{} は組込みのプロファイルを置き換えます"};
inline constexpr Text unknown_model{"there is no model '{}'", "機種 '{}' はありません"};
inline constexpr Text several_models{"'{}' means several models", "'{}' は複数の機種に該当します"};
inline constexpr Text known_models{"the models are {}", "機種: {}"};

inline constexpr Text true_of_others{"{} (likewise nodes {})", "{} (ノード {} も同様)"};
inline constexpr Text nothing_written_hint{"nothing was written", "何も書き込んでいません"};
inline constexpr Text nothing_matches_list{"no node on {} matches -n {}",
                                           "{} 上に -n {} に該当するノードがありません"};

inline constexpr Text question_yes_no{"Go on? [y/N] ", "続けますか? [y/N] "};
inline constexpr Text not_confirmed{"not confirmed: nothing was written",
                                    "確認されなかったため書き込んでいません"};
inline constexpr Text not_confirmed_hint{"add --yes to agree beforehand",
                                         "事前に同意するには --yes を付けて下さい"};

inline constexpr Text not_confirmed_by_option_hint{
    "add {} to agree beforehand: --yes is not enough",
    "事前に同意するには {} が必要です (--yes では不十分)"};

// -v
inline constexpr Text from_environment{"{} {}: from {}", "{} {}: {} による指定"};
inline constexpr Text only_interface{"using {}: the only CAN interface that is up",
                                     "{} を使います: 起動している唯一の CAN インターフェース"};
inline constexpr Text no_own_id{"no node ID of our own: nothing is sent",
                                "自ノード ID なし: 送信しません"};
inline constexpr Text own_id_free{"own node ID {}: it was free", "自ノード ID {}: 空いていました"};
inline constexpr Text own_id_wanted{"own node ID {}: as --local-node-id says",
                                    "自ノード ID {}: --local-node-id の指定"};
inline constexpr Text own_id_private{"own node ID {}: no other process reaches this bus",
                                     "自ノード ID {}: 他のプロセスが使えないバスです"};
inline constexpr Text own_id_instead{"own node ID {}: {}", "自ノード ID {}: {}"};
inline constexpr Text lock_taken{"lock file: {}", "ロックファイル: {}"};
inline constexpr Text no_lock_folder{
    "no folder for lock files can be written: other blactl processes on {} are not kept away",
    "ロックファイルを置けるディレクトリがないため、{} 上の他の blactl "
    "プロセスとの競合を防げません"};
inline constexpr Text asked_again{"node {}: no answer to {} within {} s: asked again ({} of {})",
                                  "ノード {}: {} に {} 秒以内の応答なし: 再要求 ({}/{})"};
inline constexpr Text never_answered{"node {}: no answer to {} within {} s, tries: {}",
                                     "ノード {}: {} に {} 秒以内の応答なし、要求回数: {}"};
inline constexpr Text sent_once_more{"node {}: {} was not carried out: sent once more",
                                     "ノード {}: {} が実行されていないため、もう一度送信しました"};
inline constexpr Text adapter_sent{"to the adapter: {}", "アダプターへ: {}"};
inline constexpr Text adapter_said{"from the adapter: {}", "アダプターから: {}"};
inline constexpr Text adapter_said_much{"from the adapter: {}… ({} bytes)",
                                        "アダプターから: {}… ({} バイト)"};

// scan
inline constexpr Text expected_more{"servos found: {}, expected: {}",
                                    "サーボ {} 台を検出しました (期待 {} 台)"};
inline constexpr Text expected_more_hint{
    "is every servo powered and connected? listen longer with --listen SEC",
    "電源と配線を確認するか、--listen で待ち時間を延ばして下さい"};
inline constexpr Text nobody_there{"no node was heard on {}", "{} 上にノードが見つかりません"};
inline constexpr Text nobody_there_hint{
    "is the supply on? does a servo without an ID wait for one? is the bit rate 1000000?",
    "電源、ノード ID 割当て待ちのサーボ、ビットレート 1000000 を確認して下さい",
};
inline constexpr Text silent_slcan_hint{
    "is the supply on, and the bit rate of the bus 1000000? is a servo connected to the adapter?",
    "サーボの電源、バスのビットレート 1000000、アダプターとの接続を確認して下さい"};
inline constexpr Text silent_mcast_hint{
    "is a peer there? the bus number and the network interface of {} must be its own too: "
    "-i mcast:N?if=IFACE",
    "{} に相手がいるか、バス番号とネットワークインターフェースが相手と同じか確認して下さい: "
    "-i mcast:N?if=IFACE"};
inline constexpr Text silent_sim_hint{
    "is a servo in the scenario of `blactl sim`, powered and plugged in? type dump there",
    "`blactl sim` のシナリオにサーボがあり、電源と接続が有効か確認して下さい (dump と入力)"};
inline constexpr Text silent_simulator_hint{
    "is a servo in the scenario of the simulator at {}, powered and plugged in? type dump there",
    "{} のシミュレータのシナリオにサーボがあり、電源と接続が有効か確認して下さい (dump と入力)"};
inline constexpr Text silent_scenario_hint{
    "is a servo in the scenario {}, and do its \"events\" leave it powered and plugged in?",
    "シナリオ {} にサーボがあり、\"events\" で電源や接続が切れていないか確認して下さい"};
inline constexpr Text silent_log_hint{
    "{0} holds nothing that a DroneCAN node said: is it the right log? blactl trace {0}",
    "{0} には DroneCAN ノードの送信がありません。正しいログか確認して下さい: blactl trace {0}"};
inline constexpr Text silent_file_hint{"{} holds no entry of one servo: blactl export writes them",
                                       "{} にサーボ 1 台のエントリがありません。作成するには: "
                                       "blactl export"};
inline constexpr Text file_entries_of_many{
    "entries that mean every servo of a model, and none in particular, are skipped: {}",
    "機種全体の設定で特定のサーボを指さないエントリを無視しました: {}"};
inline constexpr Text file_without_node_ids{
    "entries without a node ID, and the numbers that stand for them in messages: {}",
    "ノード ID の無いエントリ (括弧内はメッセージで使う番号): {}"};
inline constexpr Text file_not_recorded_hint{
    "a fleet file holds the settings of a servo and which one it is; only the servo itself has the "
    "rest: -i can0",
    "フリートファイルには設定と機種などの情報しかありません。他の値はサーボから読み出して下さい: "
    "-i can0"};
inline constexpr Text file_without_frames{"{}: a fleet file holds no frames",
                                          "{}: フリートファイルにフレームはありません"};
inline constexpr Text file_without_frames_hint{
    "--record and --report need frames: give a log, or the interface that the servos are on",
    "--record と --report にはフレームが必要です。ログか、サーボを接続した"
    "インターフェースを指定して下さい"};
inline constexpr Text waits_for_id{"waits for a node ID: unique ID {}…",
                                   "ノード ID 割当て待ち: 固有 ID {}…"};
inline constexpr Text more_may_wait{
    "more servos may wait than were heard: they ask at random times (--listen 10 hears longer)",
    "受信できていない割当て待ちのサーボがあるかもしれません。要求の間隔は不定です "
    "(--listen 10 でより長く受信)"};
inline constexpr Text column_node{"NODE", "ノード"};
inline constexpr Text column_model{"MODEL", "機種"};
inline constexpr Text column_serial{"SERIAL", "製造番号"};
inline constexpr Text column_servo_id{"SERVO", "サーボ"};
inline constexpr Text column_firmware{"FIRMWARE", "ファームウェア"};
inline constexpr Text scan_column_firmware{"FW", "FW"};
inline constexpr Text column_static_id{"STATIC", "固定"};
inline constexpr Text column_state{"STATE", "状態"};
inline constexpr Text column_uptime{"UPTIME", "稼働"};
inline constexpr Text column_unique_id{"UID", "UID"};
inline constexpr Text dynamic_id{"dynamic", "動的"};
inline constexpr Text foreign_node{"(not a BLA servo) {}", "(BLA サーボ以外) {}"};

// get, set
inline constexpr Text head_line{"node {}  {}  serial {}  servo ID {}  firmware {}\n",
                                "ノード {}  {}  製造番号 {}  サーボ ID {}  ファームウェア {}\n"};
inline constexpr Text unknown_value{"?", "?"};
inline constexpr Text unknown_word{"unknown", "不明"};
inline constexpr Text nothing_readable{"  nothing here can be read\n",
                                       "  読み出せるパラメータはありません\n"};
inline constexpr Text nothing_changed{"  nothing differs from its default\n",
                                      "  初期値と異なるパラメータはありません\n"};
inline constexpr Text nothing_read_changed{
    "  nothing that could be read differs from its default\n",
    "  読み出せた中に初期値と異なるパラメータはありません\n"};
inline constexpr Text nothing_with_default{"  nothing here has a default\n",
                                           "  対象に初期値のあるパラメータはありません\n"};
inline constexpr Text column_parameter{"PARAMETER", "パラメータ"};
inline constexpr Text column_value{"VALUE", "値"};
inline constexpr Text column_before{"BEFORE", "変更前"};
inline constexpr Text column_after{"AFTER", "変更後"};
inline constexpr Text column_default{"DEFAULT", "初期値"};
inline constexpr Text column_range{"RANGE", "範囲"};
inline constexpr Text column_meaning{"TITLE", "名称"};
inline constexpr Text range_text{"{} .. {}", "{} ～ {}"};
inline constexpr Text set_written{"written", "書込み済み"};
inline constexpr Text set_unchanged{"unchanged", "変更なし"};
inline constexpr Text set_failed{"failed", "失敗"};
inline constexpr Text set_mismatch{"mismatch", "不一致"};
inline constexpr Text set_planned{"planned", "予定"};
inline constexpr Text ids_not_kept{"the node IDs given now are not kept: {}",
                                   "割り当てるノード ID は保存されません: {}"};
inline constexpr Text would_save{
    "then SAVE: all of RAM goes to ROM, and the servo restarts",
    "続いて SAVE により RAM の全設定を ROM に保存し、サーボを再起動します"};
inline constexpr Text servo_not_saved{"not saved", "未保存"};
inline constexpr Text not_saved_note{
    "in RAM only: a restart brings back what ROM holds (to keep the new values: blactl save)",
    "RAM のみの変更です。再起動すると ROM の値に戻ります (保存: blactl save)",
};

// faults
inline constexpr Text level_notice{"NOTICE", "通知"};
inline constexpr Text level_warning{"WARNING", "警告"};
inline constexpr Text level_failure{"FAILURE", "障害"};
inline constexpr Text no_faults{"no faults", "異常なし"};
inline constexpr Text health_unexplained{
    "its NodeStatus says that its health is {}, and no bit of 0x18-0x1B explains that",
    "NodeStatus の健康状態は「{}」ですが、0x18-0x1B に対応する異常はありません"};
inline constexpr Text faults_unknown{"not known whether it has faults", "異常の有無は不明です"};
inline constexpr Text faults_of_before{"does not report its faults now; the last known ones:",
                                       "現在の異常は不明です。以下は最後に取得した内容です"};
inline constexpr Text faults_hidden{"not shown: {} below {}", "{} 件は{}レベル未満のため非表示"};
inline constexpr Text unknown_bit_action{
    "Ask the manufacturer, with the firmware version and the number of the bit.",
    "ファームウェアバージョンとビット番号を添えてメーカーに問い合わせて下さい。"};
inline constexpr Text fault_now{"now: {}", "現在の値: {}"};
inline constexpr Text fault_settings{"settings: {}", "設定値: {}"};
inline constexpr Text fault_output_off{
    "The output is off. Once it is on again, the earlier command is gone.",
    "モータ出力 OFF です。ON に戻っても、以前の指令は破棄されています。"};
inline constexpr Text fault_latched{
    "It shows why the servo last reset or restarted itself, not its present state.",
    "サーボが自ら初期化/再起動した原因で、現在の異常ではありません。"};
inline constexpr Text fault_event{"{}  node {}  {}  {}", "{}  ノード {}  {}  {}"};
inline constexpr Text fault_present{"present", "発生中"};
inline constexpr Text fault_came{"came", "発生"};
inline constexpr Text fault_went{"went", "解消"};
inline constexpr Text answers_again{"node {} answers again", "ノード {} の応答が回復しました"};
inline constexpr Text servo_gone{"gone (silent)", "応答なし"};
inline constexpr Text servo_back_again{"back", "応答回復"};
inline constexpr Text servo_restarted{"restarted", "再起動"};
inline constexpr Text fault_other_servo{
    "node {} is another servo now: what follows is about that one",
    "ノード {} は別のサーボに替わりました。以下はそのサーボの情報です"};
inline constexpr Text more_lines{"… more lines: {}", "… 他 {} 行"};

// results of servos
inline constexpr Text saving{"RAM to ROM:", "ROM への保存:"};
inline constexpr Text finishing{
    "waiting for servos that save or restart, 3 s at most (Ctrl-C again: at once)",
    "保存・再起動中のサーボを待っています (最大 3 秒。もう一度 Ctrl-C で即時終了)",
};
inline constexpr Text servo_done{"done", "完了"};
inline constexpr Text servo_back{"done: back as node {} after {} s",
                                 "完了: ノード {} として {} 秒で復帰"};
inline constexpr Text values_read_again{", values read again: {}", "、{} 項目を再読出し"};
inline constexpr Text back_but_failed{"failed (back as node {})", "失敗 (ノード {} として復帰)"};
inline constexpr Text servo_failed{"failed", "失敗"};
inline constexpr Text wait_there{"operational", "動作中"};
inline constexpr Text wait_not_ready{"not operational", "未動作"};
inline constexpr Text progress_change{"servos done: {} of {}, {} s{}{}", "{}/{} 台完了、{} 秒{}{}"};
inline constexpr Text progress_let_in{"servos without a node ID get one for the time being, {} s",
                                      "ID のないサーボに一時的なノード ID を割当て中、{} 秒"};
inline constexpr Text progress_at_work{"; at work: {}", "、処理中: {}"};
inline constexpr Text progress_away{"; to come back: {}", "、復帰待ち: {}"};
inline constexpr Text progress_wait{"waiting, {} of {} s; there: {}",
                                    "待機中 {}/{} 秒、動作中: {}"};
inline constexpr Text progress_scan{"listening, {} of {} s; nodes: {}",
                                    "受信中 {}/{} 秒、ノード: {}"};
inline constexpr Text no_defaults_known{
    "the model of node {} is not known, nor are its defaults: all that can be changed is shown",
    "ノード {} の機種が不明で初期値も不明のため、変更可能な全項目を表示します"};
inline constexpr Text set_not_written{"not written", "未書込み"};
inline constexpr Text do_not_cut_supply{"do not cut the supply while servos save",
                                        "保存中は電源を切らないで下さい"};

inline constexpr Text screen_unknown{"nothing is known of the terminal '{}' (TERM)",
                                     "端末 '{}' (TERM) の情報がありません"};
inline constexpr Text screen_without_cursor{
    "the terminal '{}' (TERM) cannot place its cursor: a table needs that",
    "端末 '{}' (TERM) はカーソル位置を指定できないため、表を表示できません"};
inline constexpr Text screen_hint{"set TERM to the type of the terminal, for example: TERM=xterm",
                                  "端末の種類を指定して下さい (例: TERM=xterm)"};

inline constexpr Text characterize_column_setting{"SETTING", "項目"};
inline constexpr Text characterize_column_value{"VALUE", "値"};
inline constexpr Text characterize_column_what{"MEANING", "意味"};
inline constexpr Text characterize_column_why{"WHY NOT", "理由"};
inline constexpr Text characterize_measured{"measured:\n", "測定結果:\n"};
inline constexpr Text characterize_seen{"seen beside that:\n", "その他の観測:\n"};
inline constexpr Text characterize_not_measured{"not measured:\n", "測定できなかった項目:\n"};
inline constexpr Text characterize_as_before{"the servo holds what it held before\n",
                                             "サーボの設定は測定前の状態に戻しました\n"};
inline constexpr Text characterize_written{
    "{} settings written to {}: blactl sim --facts {}\n",
    "{} 項目を {} に書き込みました: blactl sim --facts {}\n"};
inline constexpr Text characterize_putting_back{
    "putting back what was changed, 10 s at most (Ctrl-C again: at once)",
    "変更した設定を元に戻しています (最大 10 秒。もう一度 Ctrl-C で即時終了)"};
inline constexpr Text characterize_put_back_hint{"what was changed has been put back",
                                                 "変更した設定は元に戻しました"};
inline constexpr Text characterize_not_put_back_hint{"see below what was not put back",
                                                     "元に戻せなかった設定は次の通りです"};

} // namespace blactl::texts
