#pragma once
// The catalogue of the floor cli.

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
inline constexpr Text not_understood{"{}", "コマンドラインを解釈できません: {}"};
inline constexpr Text empty_value{"{}: the value is empty", "{}: 値が空です"};
inline constexpr Text takes_one_value{"{} takes one value", "{} には値を一つだけ指定して下さい"};
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
inline constexpr Text help_recordings{"Also answers from a recording: -i replay:FILE.",
                                      "記録からも読出しできます: -i replay:FILE"};
inline constexpr Text help_see_shared{"Options of all commands: see blactl --help.",
                                      "共通オプションは blactl --help を参照して下さい。"};

inline constexpr Text see_help{"see blactl --help", "blactl --help を参照して下さい"};
inline constexpr Text see_command_help{"see blactl {} --help", "blactl {} --help を参照して下さい"};
inline constexpr Text bad_seconds{"{} {}: not a number of seconds between {} and {}",
                                  "{} {}: {}～{} 秒の範囲の数ではありません"};
inline constexpr Text bad_number{"{} {}: not a whole number between {} and {}",
                                 "{} {}: {}～{} の整数ではありません"};
inline constexpr Text bad_word{"{} {}: not one of {}", "{} {}: {} のいずれでもありません"};
inline constexpr Text json_and_csv{"--json and --csv exclude each other",
                                   "--json と --csv は同時に指定できません"};
inline constexpr Text no_csv{"{} has no CSV output", "{} は CSV 出力に対応していません"};
inline constexpr Text record_needs_file{"--record needs a file: standard output is for data",
                                        "--record にはファイルを指定して下さい "
                                        "(標準出力はデータ用です)"};
inline constexpr Text nothing_to_record{"{} has no session that could be recorded",
                                        "{} には記録できるセッションがありません"};
inline constexpr Text records_itself{"--record {}: that is the log being read",
                                     "--record {}: 読込み中のログと同じファイルです"};
inline constexpr Text lines_passed_over{
    "{}: lines passed over because they are no frames: {}, the first is line {}",
    "{}: フレームではない {} 行を無視しました (最初は {} 行目)"};
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
    "for example -i can0, -i slcan:/dev/ttyUSB0, -i mcast:0, -i sim:SCENARIO.json, -i replay:FILE",
    "例: -i can0, -i slcan:/dev/ttyUSB0, -i mcast:0, -i sim:SCENARIO.json, -i replay:FILE",
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
inline constexpr Text bad_mcast{"-i {}: not of the form mcast:N or mcast:N?if=IFACE",
                                "-i {}: mcast:N または mcast:N?if=IFACE の形ではありません"};
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

inline constexpr Text nothing_written_hint{"nothing was written", "何も書き込んでいません"};
inline constexpr Text nothing_matches_list{"no node on {} matches -n {}",
                                           "{} 上に -n {} に該当するノードがありません"};

inline constexpr Text question_yes_no{"Go on? [y/N] ", "続けますか? [y/N] "};
inline constexpr Text not_confirmed{"not confirmed: nothing was written",
                                    "確認されなかったため書き込んでいません"};
inline constexpr Text not_confirmed_hint{"add --yes to agree beforehand",
                                         "事前に同意するには --yes を付けて下さい"};

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
inline constexpr Text expected_more{"{} servos found, {} expected",
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
inline constexpr Text waits_for_id{"waits for a node ID: unique ID {}…",
                                   "ノード ID 割当て待ち: 固有 ID {}…"};
inline constexpr Text more_may_wait{
    "more servos may wait than were heard: they ask at random times (--listen 10 hears longer)",
    "受信できていない割当て待ちのサーボがあるかもしれません。要求の間隔は不定です "
    "(--listen 10 でより長く受信)"};
inline constexpr Text allocates{"node {} allocates node IDs",
                                "ノード {} がノード ID を割り当てています"};
inline constexpr Text commands_servos{"node {} commands servos",
                                      "ノード {} がサーボに動作指令しています"};
inline constexpr Text says_armed{"node {} says armed", "ノード {} は ARM 状態です"};
inline constexpr Text column_node{"NODE", "ノード"};
inline constexpr Text column_model{"MODEL", "機種"};
inline constexpr Text column_models{"MODELS", "機種"};
inline constexpr Text column_serial{"SERIAL", "製造番号"};
inline constexpr Text column_servo_id{"SERVO ID", "サーボ ID"};
inline constexpr Text column_firmware{"FIRMWARE", "ファームウェア"};
inline constexpr Text column_static_id{"STATIC ID", "固定 ID"};
inline constexpr Text column_state{"STATE", "状態"};
inline constexpr Text column_uptime{"UPTIME", "稼働時間"};
inline constexpr Text column_unique_id{"UNIQUE ID", "固有 ID"};
inline constexpr Text dynamic_id{"dynamic", "動的"};
inline constexpr Text foreign_node{"(not a BLA servo) {}", "(BLA サーボ以外) {}"};

// get, set
inline constexpr Text head_line{"node {}  {}  serial {}  servo ID {}  firmware {}\n",
                                "ノード {}  {}  製造番号 {}  サーボ ID {}  ファームウェア {}\n"};
inline constexpr Text unknown_value{"?", "?"};
inline constexpr Text unknown_word{"unknown", "不明"};
inline constexpr Text nothing_changed{"  every parameter has its default\n",
                                      "  すべてのパラメータが初期値です\n"};
inline constexpr Text column_parameter{"PARAMETER", "パラメータ"};
inline constexpr Text column_value{"VALUE", "値"};
inline constexpr Text column_before{"BEFORE", "変更前"};
inline constexpr Text column_after{"AFTER", "変更後"};
inline constexpr Text column_default{"DEFAULT", "初期値"};
inline constexpr Text column_range{"RANGE", "範囲"};
inline constexpr Text range_text{"{} .. {}", "{} ～ {}"};
inline constexpr Text set_written{"written", "書込み済み"};
inline constexpr Text set_unchanged{"unchanged", "変更なし"};
inline constexpr Text set_failed{"failed", "失敗"};
inline constexpr Text set_mismatch{"mismatch", "不一致"};
inline constexpr Text set_planned{"planned", "予定"};
inline constexpr Text not_saved_note{
    "in RAM only: a restart brings the old values back (to keep them: blactl save)",
    "RAM のみの変更です。再起動すると元の値に戻ります (保存: blactl save)",
};

// trace
inline constexpr Text unknown_type{"there is no data type '{}'", "データ型 '{}' はありません"};
inline constexpr Text unknown_type_hint{
    "give a name such as NodeStatus or param.GetSet, or a data type ID",
    "NodeStatus や param.GetSet などの名前、またはデータ型 ID を指定して下さい"};
inline constexpr Text trace_takes_node_ids{"-n {}: trace takes node IDs only",
                                           "-n {}: trace で指定できるのはノード ID のみです"};
inline constexpr Text trace_takes_node_ids_hint{"which servo has which ID: blactl scan",
                                                "どのサーボがどの ID かを調べるには: blactl scan"};
inline constexpr Text log_has_many_interfaces{
    "{} frames were not decoded: the log names more than {} interfaces",
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
inline constexpr Text trace_load{"{}: {} frames in {} s, {} % of 1 Mbit/s\n",
                                 "{}: {} フレーム / {} 秒、バス負荷 {} % (1 Mbit/s)\n"};

// models
inline constexpr Text models_pwm{"with PWM input", "PWM 入力対応"};
inline constexpr Text models_no_pwm{"without PWM input", "PWM 入力未対応"};
inline constexpr Text column_voltage{"VOLTAGE", "電圧クラス"};
inline constexpr Text column_numbers{"MODEL NUMBER / HARDWARE", "機種番号 / ハードウェア"};
inline constexpr Text column_access{"ACCESS", "R/W"};
inline constexpr Text column_meaning{"TITLE", "名称"};
inline constexpr Text column_shipped{"SHIPPED", "出荷時期"};
inline constexpr Text column_changes{"CHANGES", "変更内容"};
inline constexpr Text models_unit_by_mode{
    "unit deg in steps of 0.1, or rpm in steps of 1, as pwm_mode says",
    "単位 deg (分解能 0.1) または rpm (分解能 1)、動作モードによる"};
inline constexpr Text models_unit{"unit {}, in steps of {}", "単位 {}、分解能 {}"};
// faults
inline constexpr Text level_notice{"NOTICE", "通知"};
inline constexpr Text level_warning{"WARNING", "警告"};
inline constexpr Text level_failure{"FAILURE", "障害"};
inline constexpr Text no_faults{"no faults", "異常なし"};
inline constexpr Text faults_unknown{"not known whether it has faults", "異常の有無は不明です"};
inline constexpr Text faults_hidden{"{} below {} not shown", "{} 件は{}レベル未満のため非表示"};
inline constexpr Text unknown_bit_action{
    "Ask the manufacturer, with the firmware version and the number of the bit.",
    "ファームウェアバージョンとビット番号を添えてメーカーに問い合わせて下さい。"};
inline constexpr Text fault_now{"now: {}", "現在値: {}"};
inline constexpr Text fault_latched{
    "It tells why the servo last reset or restarted itself, not its state now.",
    "サーボが自ら初期化/再起動した原因で、現在の異常ではありません。"};
inline constexpr Text fault_event{"{}  node {}  {}  {}", "{}  ノード {}  {}  {}"};
inline constexpr Text fault_present{"present", "発生中"};
inline constexpr Text fault_came{"came", "発生"};
inline constexpr Text fault_went{"went", "解消"};
inline constexpr Text answers_again{"node {} answers again", "ノード {} の応答が回復しました"};
inline constexpr Text more_lines{"… {} more lines", "… 他 {} 行"};

// pwm-config
inline constexpr Text pwm_one_way{
    "one of three ways: --endpoints, --preset, or --neutral, --range, --output, --mode",
    "--endpoints、--preset、または --neutral / --range / --output / --mode "
    "のいずれか一つの方法で指定して下さい"};
inline constexpr Text pwm_mode_needs_output{
    "--mode without --output: the output range counts in the unit of the mode",
    "--mode には --output も必要です (出力範囲の単位が動作モードで変わるため)"};
inline constexpr Text pwm_mode_hint{"for example --mode speed --output 150rpm",
                                    "例: --mode speed --output 150rpm"};
inline constexpr Text pwm_output_symmetric{
    "--output {}: the range is the same to either side, so it is one positive value",
    "--output {}: 出力範囲は両側対称です。正の値を一つ指定して下さい"};
inline constexpr Text pwm_output_hint{"for example --output 70deg", "例: --output 70deg"};
inline constexpr Text pwm_nothing_to_change{"{}: nothing to change is given",
                                            "{}: 変更内容の指定がありません"};
inline constexpr Text pwm_nothing_hint{
    "say what: --neutral, --range, --output, --mode, --endpoints or --preset",
    "--neutral、--range、--output、--mode、--endpoints、--preset のいずれかを指定して下さい"};
inline constexpr Text pwm_svg_one_servo{"--svg draws one servo, not {}",
                                        "--svg で描画できるのは 1 台です ({} 台指定)"};
inline constexpr Text pwm_svg_to_stdout{"--svg needs a file: standard output is for data",
                                        "--svg にはファイルを指定して下さい "
                                        "(標準出力はデータ用です)"};
inline constexpr Text pwm_svg_hint{"choose it: -n", "-n で 1 台選んで下さい"};
inline constexpr Text pwm_unknown{"the PWM mapping is not known", "PWM の設定を取得できません"};
inline constexpr Text pwm_pulses{"  pulses   {} us +-{} us: {} to {} us\n",
                                 "  パルス幅  {} us ±{} us: {} ～ {} us\n"};
inline constexpr Text pwm_output{"  command  +-{} ({})\n", "  指令値    ±{} ({})\n"};
inline constexpr Text pwm_angle{"angle", "角度"};
inline constexpr Text pwm_speed{"speed", "速度"};
inline constexpr Text pwm_input_now{"  input    {}\n", "  現在入力  {}\n"};
inline constexpr Text pwm_input_ok{"a pulse within the range", "入力範囲内のパルスあり"};
inline constexpr Text pwm_input_none{"no pulse", "パルス無し"};
inline constexpr Text pwm_input_short{"a pulse at or below the shortest", "パルス下限以下"};
inline constexpr Text pwm_input_long{"a pulse at or above the longest", "パルス上限以上"};
inline constexpr Text pwm_fallback{
    "  CAN      goes first; PWM counts after {} ms without CAN (timeout_time)\n",
    "  CAN 指令  優先。CAN 指令が {} ms 以上無いと PWM が有効になります (timeout_time)\n"};
inline constexpr Text pwm_cut_below{"  limit    below {} us it stays at {}\n",
                                    "  制限      {} us 未満では {} にとどまります\n"};
inline constexpr Text pwm_cut_above{"  limit    above {} us it stays at {}\n",
                                    "  制限      {} us を超えると {} にとどまります\n"};
inline constexpr Text pwm_before{"  before   {}\n", "  変更前    {}\n"};
inline constexpr Text column_pulse{"PULSE", "パルス幅"};
inline constexpr Text column_command{"COMMAND", "指令値"};
inline constexpr Text pwm_limited_to{", limited to {}", " ({} に制限)"};
inline constexpr Text pwm_neutral_point{"neutral", "ニュートラル"};
inline constexpr Text pwm_shortest_point{"shortest", "下限"};
inline constexpr Text pwm_longest_point{"longest", "上限"};
inline constexpr Text pwm_limit_point{"limit", "動作制限"};
inline constexpr Text pwm_autopilot_point{"usual autopilot pulse", "フライトコントローラの標準値"};

inline constexpr Text models_bit{"bit {}: {}", "bit {}: {}"};
inline constexpr Text models_bit_latched{"stays until the next start", "次回起動時まで保持"};
inline constexpr Text models_bit_pwm_only{"models with a PWM input only", "PWM 入力対応機種のみ"};
inline constexpr Text models_since{"firmware {} or later", "ファームウェア {} 以降"};
inline constexpr Text models_vendor_label{"manufacturer's program: {}",
                                          "メーカー製ツールの表示: {}"};
inline constexpr Text models_section{"specification: section {}", "仕様書: {}"};
inline constexpr Text models_all{"all models", "全機種"};
inline constexpr Text models_same{"What they have in common:", "共通のパラメータ:"};
inline constexpr Text models_differ{"Where they differ:", "機種により異なるパラメータ:"};
inline constexpr Text models_checks{"When it is changed, each only where it applies:",
                                    "変更時 (該当する場合のみ):"};
inline constexpr Text models_refusal{"refused", "拒否"};
inline constexpr Text models_question{"asked first", "確認"};
inline constexpr Text models_warning{"warning", "警告"};
inline constexpr Text models_see{"See also: {}", "関連: {}"};
inline constexpr Text models_group_of_one{"a parameter or a group, not both",
                                          "パラメータとグループは同時に指定できません"};
inline constexpr Text models_group_of_one_hint{
    "type one of them, for example: blactl models --group {}",
    "どちらか一方を指定して下さい。例: blactl models --group {}"};
inline constexpr Text models_saved{"stored in ROM by save", "ROM に保存される"};
inline constexpr Text models_not_saved{"not stored in ROM", "ROM に保存されない"};

// sim
inline constexpr Text wire_is_real{"{} has a wire of its own: the scenario cannot give it faults",
                                   "{} は実際のバスです: シナリオのバス障害は適用できません"};
inline constexpr Text wire_is_real_hint{"without -i the simulator has a wire that can fail",
                                        "-i を省くと、障害を起こせる模擬バスになります"};
inline constexpr Text sim_serves{"{}: simulated servos: {} (Ctrl-C ends)",
                                 "{}: サーボ {} 台をシミュレート中 (Ctrl-C で終了)"};
inline constexpr Text sim_event{"{}  {}  serial {}  node {}  count {}",
                                "{}  {}  製造番号 {}  ノード {}  書込み回数 {}"};
inline constexpr Text sim_memory{"serial {}  node {}  ROM writes {}  ",
                                 "製造番号 {}  ノード {}  ROM 書込み {} 回  "};
inline constexpr Text sim_unsaved{"{}: RAM {}, ROM {}; ", "{}: RAM {}、ROM {}; "};
inline constexpr Text sim_all_saved{"RAM as ROM", "RAM と ROM は同じ"};
inline constexpr Text sim_load{"bus load {} %, frames {}, destroyed {}",
                               "バス負荷 {} %、フレーム {}、破損 {}"};
inline constexpr Text sim_order_unknown{"not understood: {}", "解釈できません: {}"};
inline constexpr Text sim_order_hint{
    "SERIAL voltage=5V …, clients cut, clients joined, clients bus_off, hold N, dump",
    "製造番号 voltage=5V …、clients cut、clients joined、clients bus_off、hold N、dump"};
inline constexpr Text sim_no_such_serial{"no servo has the serial number {}",
                                         "製造番号 {} のサーボはありません"};
inline constexpr Text sim_needs_virtual_clock{"only with --clock virtual: {}",
                                              "--clock virtual でのみ使えます: {}"};
inline constexpr Text sim_order_impossible{"not on a real interface: {}",
                                           "実際のバスでは使えません: {}"};
inline constexpr Text sim_events_dropped{
    "events that nobody read in time and that are not printed: {}",
    "読み取られなかったため出力していないイベント: {}"};
inline constexpr Text scenario_is_argument{"-i {}: a scenario is an argument of sim",
                                           "-i {}: シナリオは sim の引数で指定します"};
inline constexpr Text scenario_is_argument_hint{"blactl sim {}", "blactl sim {}"};

inline constexpr Text saving{"RAM to ROM:", "ROM への保存:"};
inline constexpr Text finishing{
    "waiting for servos that save or restart, 3 s at most (Ctrl-C again: at once)",
    "保存・再起動中のサーボを待っています (最大 3 秒。もう一度 Ctrl-C で即時終了)",
};
inline constexpr Text servo_done{"done", "完了"};
inline constexpr Text servo_back{"done: back as node {} after {} s",
                                 "完了: ノード {} として {} 秒で復帰"};
inline constexpr Text values_read_again{", {} values read again", "、{} 項目を再読出し"};
inline constexpr Text back_but_failed{"failed (back as node {})", "失敗 (ノード {} として復帰)"};
inline constexpr Text servo_failed{"failed", "失敗"};
inline constexpr Text wait_there{"operational", "動作中"};
inline constexpr Text wait_not_ready{"not operational", "未動作"};
inline constexpr Text progress_change{"{} of {} servos done, {} s{}{}", "{}/{} 台完了、{} 秒{}{}"};
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
inline constexpr Text did_not_tell_ids{
    "node {} did not say which IDs it has: a conflict with it cannot be ruled out",
    "ノード {} の ID を読み出せないため、重複の有無は確認できません"};
inline constexpr Text do_not_cut_supply{"do not cut the supply while servos save",
                                        "保存中は電源を切らないで下さい"};

} // namespace blactl::texts
