#pragma once
// The catalogue of the floor cli.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text stdout_failed{"cannot write to standard output: {}",
                                    "標準出力に書き込めません: {}"};
inline constexpr Text stdout_failed_hint{"free some space, or send the output elsewhere",
                                         "空き容量を確保するか、出力先を変更してください"};

inline constexpr Text unknown_command{"there is no command '{}'", "コマンド '{}' はありません"};
inline constexpr Text no_command{"no command given", "コマンドが指定されていません"};
inline constexpr Text unexpected_argument{"not expected: {}", "不要な引数です: {}"};
inline constexpr Text not_understood{"{}", "コマンドラインを解釈できません: {}"};
inline constexpr Text empty_value{"{}: the value is empty", "{}: 値が空です"};
inline constexpr Text takes_one_value{"{} takes one value", "{} には値を一つだけ指定してください"};
inline constexpr Text assignment_missing{"PARAM=VALUE is missing", "PARAM=VALUE がありません"};
inline constexpr Text see_help{"see blactl --help", "blactl --help を参照してください"};
inline constexpr Text see_command_help{"see blactl {} --help",
                                       "blactl {} --help を参照してください"};
inline constexpr Text bad_seconds{"{} {}: not a number of seconds between {} and {}",
                                  "{} {}: {}～{} 秒の範囲の数ではありません"};
inline constexpr Text bad_number{"{} {}: not a whole number between {} and {}",
                                 "{} {}: {}～{} の整数ではありません"};
inline constexpr Text bad_word{"{} {}: not one of {}", "{} {}: {} のいずれでもありません"};
inline constexpr Text json_and_csv{"--json and --csv exclude each other",
                                   "--json と --csv は同時に指定できません"};
inline constexpr Text no_csv{"{} has no CSV output", "{} は CSV 出力に対応していません"};
inline constexpr Text record_needs_file{"--record needs a file: standard output is for data",
                                        "--record にはファイルを指定してください "
                                        "(標準出力はデータ用です)"};
inline constexpr Text nothing_to_record{"{} has no session that could be recorded",
                                        "{} には記録できるセッションがありません"};
inline constexpr Text records_itself{"--record {}: that is the log being read",
                                     "--record {}: 読込み中のログと同じファイルです"};
inline constexpr Text lines_passed_over{
    "{}: lines passed over because they are no frames: {}, the first is line {}",
    "{}: フレームではない {} 行を無視しました (最初は {} 行目)"};
inline constexpr Text and_more{"{} and {} more", "{} 他 {} 件"};
inline constexpr Text listen_only_refused{
    "{} must send, which --listen-only forbids",
    "{} は送信が必要なため --listen-only では実行できません",
};
inline constexpr Text listen_only_hint{"leave --listen-only out", "--listen-only を外してください"};

inline constexpr Text bad_interface{"-i {}: no such kind of interface",
                                    "-i {}: この種類のインタフェースはありません"};
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
    "N は 0～255、IFACE はネットワークインタフェースです (例: -i mcast:0?if=lo)",
};
inline constexpr Text mcast_chosen{"using {} (another interface: ?if=IFACE)",
                                   "{} を使います (変更するには ?if=IFACE)"};
inline constexpr Text no_interface{"no CAN interface is up",
                                   "起動している CAN インタフェースがありません"};
inline constexpr Text several_interfaces{"several CAN interfaces are up: {}",
                                         "起動している CAN インタフェースが複数あります: {}"};
inline constexpr Text several_interfaces_hint{"choose one: -i {}", "一つ選んでください: -i {}"};
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

inline constexpr Text unknown_group{"there is no group '{}'", "グループ '{}' はありません"};
inline constexpr Text known_groups{"the groups are {}", "グループ: {}"};
inline constexpr Text write_only{"{} can only be written", "{} は書込み専用です"};
inline constexpr Text write_only_hint{"it is a command of the servo, not a value",
                                      "値ではなくサーボへの命令です"};
inline constexpr Text firmware_lacks{"{} needs firmware {} or later, this servo has {}",
                                     "{} にはファームウェア {} 以降が必要です (現在 {})"};
inline constexpr Text firmware_lacks_hint{"read what it has: blactl get -n {}",
                                          "読み出せるパラメータ: blactl get -n {}"};

inline constexpr Text several_servos{"several servos are on the bus: {}",
                                     "バス上に複数のサーボがあります: {}"};
inline constexpr Text several_servos_hint{"say which: -n {}", "-n {} のように指定してください"};
inline constexpr Text one_command_only{
    "command_angle, command_speed and command_torque exclude each other",
    "command_angle、command_speed、command_torque は同時に指定できません",
};
inline constexpr Text one_command_only_hint{
    "the servo obeys the last one: give just that",
    "最後の指令だけが有効になるため、一つだけ指定してください"};
inline constexpr Text nothing_written_hint{"nothing was written", "何も書き込んでいません"};
inline constexpr Text lost_while_listening{
    "frames were lost while listening: who drives or is armed is not known",
    "受信中にフレームを失ったため、動作指令や ARM 状態を確認できません",
};
inline constexpr Text nothing_matches_list{"no node on {} matches -n {}",
                                           "{} 上に -n {} に該当するノードがありません"};
inline constexpr Text one_id_for_several{
    "one static node ID for {} servos: they would collide after a restart",
    "{} 台のサーボに同じ固定ノード ID を設定すると再起動後に重複します",
};
inline constexpr Text one_id_for_several_hint{"give each its own: -n {}",
                                              "一台ずつ設定してください: -n {}"};
inline constexpr Text not_written{"{} frames of a write may still be in the queue of {}: "
                                  "what they change is not known",
                                  "書込みの {} フレームが {} の送信キューに残っている可能性があり、"
                                  "変更結果は不明です"};

// Questions before something that moves or lets go.
inline constexpr Text question_may_move{
    "This can move the shaft or let go of the load:\n",
    "出力軸が動く、または負荷を保持できなくなる可能性があります:\n"};
inline constexpr Text question_change{"  node {}: {} {} -> {}\n", "  ノード {}: {} {} -> {}\n"};
inline constexpr Text question_yes_no{"Go on? [y/N] ", "続けますか? [y/N] "};
inline constexpr Text not_confirmed{"not confirmed: nothing was written",
                                    "確認されなかったため書き込んでいません"};
inline constexpr Text not_confirmed_hint{"add --yes to agree beforehand",
                                         "事前に同意するには --yes を付けてください"};
inline constexpr Text unknown_before{"?", "?"};

// scan
inline constexpr Text expected_more{"{} servos found, {} expected",
                                    "サーボ {} 台を検出しました (期待 {} 台)"};
inline constexpr Text expected_more_hint{
    "is every servo powered and connected? listen longer with --listen SEC",
    "電源と配線を確認するか、--listen で待ち時間を延ばしてください"};
inline constexpr Text conflict_hint{"connect one of them alone and give it another ID",
                                    "一台ずつ接続して別の ID を設定してください"};
inline constexpr Text doubled_servo_id_hint{
    "give one of them another: blactl set -n {} servo_id=ID",
    "一方に別の ID を設定してください: blactl set -n {} servo_id=ID"};
inline constexpr Text nobody_there{"no node was heard on {}", "{} 上にノードが見つかりません"};
inline constexpr Text nobody_there_hint{
    "is the supply on? does a servo without an ID wait for one? is the bit rate 1000000?",
    "電源、ノード ID 割当て待ちのサーボ、ビットレート 1000000 を確認してください",
};
inline constexpr Text waits_for_id{"waits for a node ID: unique ID {}…",
                                   "ノード ID 割当て待ち: ユニーク ID {}…"};
inline constexpr Text allocates{"node {} allocates node IDs",
                                "ノード {} がノード ID を割り当てています"};
inline constexpr Text commands_servos{"node {} commands servos",
                                      "ノード {} がサーボに動作指令しています"};
inline constexpr Text says_armed{"node {} says armed", "ノード {} は ARM 状態です"};
inline constexpr Text warn_stall{
    "firmware {} may stall at low speed; 1.400 mends it",
    "ファームウェア {} は低速動作時に停止することがあります (1.400 で修正)",
};
inline constexpr Text warn_unknown_model{"no profile fits: it can only be read",
                                         "該当するプロファイルが無いため読出しのみ可能です"};
inline constexpr Text warn_uncertain_model{
    "hardware version {} is not in table 3-12: model by its leading digits only",
    "ハードウェアバージョン {} は表 3-12 にありません。機種は先頭の桁のみで判定しました",
};
inline constexpr Text warn_static_id_differs{"will come back as node {} after a restart",
                                             "再起動後はノード {} になります"};
inline constexpr Text warn_health{"health: {} (see 0x1A, 0x1B)", "ヘルス: {} (0x1A, 0x1B を参照)"};
inline constexpr Text column_node{"NODE", "ノード"};
inline constexpr Text column_model{"MODEL", "機種"};
inline constexpr Text column_serial{"SERIAL", "製造番号"};
inline constexpr Text column_servo_id{"SERVO ID", "サーボ ID"};
inline constexpr Text column_firmware{"FIRMWARE", "ファームウェア"};
inline constexpr Text column_static_id{"STATIC ID", "固定 ID"};
inline constexpr Text column_state{"STATE", "状態"};
inline constexpr Text column_uptime{"UPTIME", "稼働時間"};
inline constexpr Text column_unique_id{"UNIQUE ID", "ユニーク ID"};
inline constexpr Text dynamic_id{"dynamic", "動的"};
inline constexpr Text foreign_node{"(not a BLA servo) {}", "(BLA サーボ以外) {}"};

// get, set
inline constexpr Text head_line{"node {}  {}  serial {}  servo ID {}  firmware {}\n",
                                "ノード {}  {}  製造番号 {}  サーボ ID {}  ファームウェア {}\n"};
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
    "in RAM only: a restart brings the old values back",
    "RAM のみの変更です。再起動すると元の値に戻ります",
};

// trace
inline constexpr Text unknown_type{"there is no data type '{}'", "データ型 '{}' はありません"};
inline constexpr Text unknown_type_hint{
    "give a name such as NodeStatus or param.GetSet, or a data type ID",
    "NodeStatus や param.GetSet などの名前、またはデータ型 ID を指定してください"};
inline constexpr Text trace_takes_node_ids{"-n {}: trace takes node IDs only",
                                           "-n {}: trace で指定できるのはノード ID のみです"};
inline constexpr Text trace_takes_node_ids_hint{"which servo has which ID: blactl scan",
                                                "どのサーボがどの ID かを調べるには: blactl scan"};
inline constexpr Text log_has_many_interfaces{
    "{} frames were not decoded: the log names more than {} interfaces",
    "{} フレームをデコードしていません (ログのインタフェース数が {} を超えています)"};
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
inline constexpr Text column_interface{"INTERFACE", "インタフェース"};
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
inline constexpr Text models_pwm{"PWM input", "PWM 入力あり"};
inline constexpr Text models_no_pwm{"no PWM input", "PWM 入力なし"};
inline constexpr Text column_voltage{"VOLTAGE", "電圧クラス"};
inline constexpr Text column_numbers{"0x50 / 0x53", "0x50 / 0x53"};
inline constexpr Text column_access{"ACCESS", "R/W"};
inline constexpr Text column_meaning{"MEANING", "名称"};
inline constexpr Text models_since{"firmware {} or later", "ファームウェア {} 以降"};
inline constexpr Text models_vendor_label{"vendor's program: {}", "メーカー製ツールの表示: {}"};
inline constexpr Text models_saved{"kept by save", "保存対象"};
inline constexpr Text models_not_saved{"not kept by save", "保存対象外"};

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
inline constexpr Text model_unknown{"the model is not known: it can only be read",
                                    "機種が不明のため読出しのみ可能です"};
inline constexpr Text question_restart_soft{
    "node {}: torque is on: its output drops, then the shaft runs slowly to 0 deg\n",
    "ノード {}: トルク ON のため、出力が一旦 OFF になり、ソフトスタートで 0° へ動きます\n",
};
inline constexpr Text question_restart_hard{
    "node {}: torque is on: its output drops, then returns where the shaft is\n",
    "ノード {}: トルク ON のため、出力が一旦 OFF になり、その位置で再び ON になります\n",
};
inline constexpr Text question_erase{
    "node {}: everything to factory defaults, servo_id {} -> 0, static_node_id {} -> 0; "
    "commands become 0 deg\n",
    "ノード {}: 全ての設定を初期値に戻します。servo_id {} -> 0, static_node_id {} -> 0。"
    "指令値は 0° になります\n",
};
inline constexpr Text question_erase_keep{
    "node {}: everything but its IDs to factory defaults; commands become 0 deg\n",
    "ノード {}: ID 以外の設定を初期値に戻します。指令値は 0° になります\n",
};
inline constexpr Text back_not_verified{"node {} is back, but its values were not read again",
                                        "ノード {} は復帰しましたが、値を再確認していません"};
inline constexpr Text passage_done{"done", "完了"};
inline constexpr Text passage_back{"done: back as node {} after {} s",
                                   "完了: ノード {} として {} 秒で復帰"};
inline constexpr Text passage_values{", {} values read again", "、{} 項目を再読出し"};
inline constexpr Text passage_back_failed{"failed (back as node {})",
                                          "失敗 (ノード {} として復帰)"};
inline constexpr Text passage_failed{"failed", "失敗"};
inline constexpr Text wait_there{"operational", "動作中"};
inline constexpr Text wait_not_ready{"not operational", "未動作"};
inline constexpr Text wait_not_operational{"node {} was heard but not operational after {} s",
                                           "ノード {} は {} 秒待っても動作状態になりません"};
inline constexpr Text wait_not_heard{"node {} was not heard within {} s",
                                     "ノード {} は {} 秒以内に見つかりません"};

} // namespace blactl::texts
