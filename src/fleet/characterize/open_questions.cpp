// All settings of the simulator that only a real servo can settle, in one table.

#include "fleet/characterize/findings.hpp"

#include <algorithm>
#include <array>

namespace blactl::fleet {

namespace {

// Reasons why a bench cannot or must not measure something.
constexpr Text unfinished{"the measuring did not come to it", "測定に至りませんでした"};
constexpr Text out_of_range{"would take a command out of range: only 0x27 is ever written so",
                            "範囲外の指令が必要です (範囲外の書込みは 0x27 のみ)"};
constexpr Text needs_motion{"would take a turning shaft", "出力軸を回転させる必要があります"};
constexpr Text needs_feeling{"shows only in how the shaft resists a hand",
                             "軸を手で回したときの抵抗でしか分かりません"};
constexpr Text needs_load{"would take a load that is known", "既知の負荷が必要です"};
constexpr Text needs_fault{"would take a fault of the hardware", "ハードウェア異常が必要です"};
constexpr Text needs_pulses{"would take pulses at the PWM input", "PWM 入力への信号が必要です"};
constexpr Text needs_erase{
    "would take an ERASE, after which the shaft may run to 0 deg at full speed",
    "ERASE が必要で、出力軸が全速で 0° へ動く可能性があります"};
constexpr Text needs_own_restart{
    "would take a servo that has restarted by itself (0x1B.8, .9, .11)",
    "自ら再起動したサーボ (0x1B のビット 8・9・11) が必要です"};

constexpr std::array questions{
    // Responses.
    OpenQuestion{
        "answer_delay", {"from a question to its answer", "質問から応答までの時間"}, unfinished},
    OpenQuestion{"out_of_range",
                 {"a value out of range: kept out, brought to the nearest, or a failure",
                  "範囲外の値: 無視、最も近い値に補正、または失敗応答"},
                 unfinished},
    OpenQuestion{
        "reserved_reads", {"reading a reserved address", "予約アドレスの読出し"}, unfinished},
    OpenQuestion{
        "gated_reads",
        {"reading a register that the firmware lacks", "ファームウェアに無いレジスタの読出し"},
        unfinished},
    OpenQuestion{
        "write_only_reads",
        {"reading a register that is only written (0x11)", "書込み専用レジスタ (0x11) の読出し"},
        unfinished},
    OpenQuestion{"index_only_access",
                 {"an index without a name is the address", "名前なしの index がアドレスになる"},
                 unfinished},
    OpenQuestion{
        "failure_with_name", {"a failure tells the name", "失敗応答に名前が付く"}, unfinished},
    OpenQuestion{"ignores_disabled_commands",
                 {"0x01 and 0x02 keep their value while 0x25 is off",
                  "0x25 が OFF の間、0x01・0x02 への書込みを無視する"},
                 unfinished},
    OpenQuestion{"answers_save_first",
                 {"SAVE is answered before it is done", "SAVE の実行前に応答する"},
                 unfinished},
    OpenQuestion{"array_command_shows",
                 {"0x00 reads what ArrayCommand brought", "ArrayCommand の指令が 0x00 に現れる"},
                 unfinished},
    OpenQuestion{"start_angle",
                 {"0x00 after a start in place: the present angle, or 0",
                  "その場で起動した後の 0x00: 現在角度または 0"},
                 unfinished},
    // Messages.
    OpenQuestion{"boot_time",
                 {"from a restart to the first frame", "再起動から最初のフレームまで"},
                 unfinished},
    OpenQuestion{"first_node_status",
                 {"from the first frame to the first NodeStatus",
                  "最初のフレームから最初の NodeStatus まで"},
                 unfinished},
    OpenQuestion{"assignment_shows",
                 {"the first NodeStatus under a new ID has mode 1",
                  "ノード ID 取得直後の NodeStatus が mode 1 になる"},
                 unfinished},
    OpenQuestion{"unused_fields",
                 {"the unused numbers of actuator.Status", "actuator.Status の未使用フィールド"},
                 unfinished},
    OpenQuestion{
        "notices_warn",
        {"bits of 0x19 make the health a warning", "0x19 のビットで health が WARNING になる"},
        unfinished},
    OpenQuestion{
        "rom_write_time",
        {"how much longer a save is silent than a restart", "保存時と再起動時の無通信時間の差"},
        unfinished},
    // Commands.
    OpenQuestion{"keeps_disabled_command",
                 {"0x01 outlives 0x25 = off; else it becomes 0",
                  "0x25 を OFF にしても 0x01 が残る (残らなければ 0)"},
                 unfinished},
    OpenQuestion{"keeps_limited_angle",
                 {"0x00 beyond 0x38 stays so; else it is the limit",
                  "0x38 を超える 0x00 がそのまま残る (残らなければ制限値)"},
                 unfinished},
    OpenQuestion{"speed_control_before_1100",
                 {"a firmware without 0x25 acts as if it were on",
                  "0x25 の無いファームウェアが ON 相当で動作する"},
                 unfinished},
    OpenQuestion{
        "inclusive_limits",
        {"a limit itself sets its bit of 0x19", "制限値ちょうどで 0x19 のビットが 1 になる"},
        unfinished},
    OpenQuestion{"inclusive_stops",
                 {"the motor stops at a limit of 0x3E to 0x41, not only beyond",
                  "0x3E～0x41 の制限値ちょうどで停止する"},
                 unfinished},
    OpenQuestion{"command_at_limit_notifies",
                 {"a commanded angle equal to 0x38 sets bit 8 of 0x19",
                  "指令角度が 0x38 と等しいとき 0x19 のビット 8 が 1 になる"},
                 unfinished},
    OpenQuestion{"array_out_of_range",
                 {"a speed out of range by ArrayCommand: ignored, or brought to the nearest",
                  "ArrayCommand の範囲外の速度: 無視、または最も近い値に補正"},
                 unfinished},
    OpenQuestion{"obeys_servo_id_0",
                 {"ArrayCommand to servo ID 0 is obeyed", "サーボ ID 0 への ArrayCommand に従う"},
                 unfinished},
    OpenQuestion{"settings_wait_for_start",
                 {"0x23, 0x27, 0x44, 0x45 take effect at the next start, not at once",
                  "0x23・0x27・0x44・0x45 が直ちにではなく次の起動から有効になる"},
                 unfinished},
    OpenQuestion{"reverse_turns_origin",
                 {"with 0x23 the offset of 0x44 turns round, too",
                  "0x23 により 0x44 のオフセットの向きも反転する"},
                 unfinished},
    OpenQuestion{"restart_keeps_failures",
                 {"bits of 0x1B outlive a restart, until the supply is off",
                  "0x1B のビットが再起動後も電源 OFF まで残る"},
                 needs_own_restart},
    OpenQuestion{
        "soft_start_shows",
        {"reads tell the limits of the soft start", "ソフトスタート中の制限が読出し値に現れる"},
        unfinished},
    // Not measured on a bench.
    OpenQuestion{"not_a_number",
                 {"a command of ArrayCommand that is no number", "数値でない ArrayCommand の指令"},
                 out_of_range},
    OpenQuestion{"beyond_unitless",
                 {"a UNITLESS command beyond -1 to 1", "±1 を超える UNITLESS の指令"},
                 out_of_range},
    OpenQuestion{"slow_speed", {"a speed below 10 rpm", "10 rpm 未満の指令速度"}, needs_motion},
    OpenQuestion{"array_command_feeds_timeout",
                 {"ArrayCommand counts for the timeout 0x27",
                  "ArrayCommand が通信タイムアウト (0x27) の判定対象になる"},
                 needs_feeling},
    OpenQuestion{"get_set_feeds_timeout",
                 {"any GetSet counts for the timeout 0x27",
                  "すべての GetSet が通信タイムアウト (0x27) の判定対象になる"},
                 needs_feeling},
    OpenQuestion{
        "timeout_beats_brake",
        {"0x26 = off lets go what 0x20 brakes", "0x20 がブレーキでも 0x26 = OFF で出力 OFF になる"},
        needs_feeling},
    OpenQuestion{"erase_holds",
                 {"0x10 and ERASE hold the angle if 0x20 was not on",
                  "0x20 が ON でないときの 0x10・ERASE 後に現在角度を保持する"},
                 needs_erase},
    OpenQuestion{
        "erase_clears_rom",
        {"0x10 and ERASE put ROM back to defaults, too", "0x10・ERASE により ROM も初期値に戻る"},
        needs_erase},
    OpenQuestion{
        "failures_latch",
        {"0x1B.0, .1, .5 stay until the next start", "0x1B のビット 0・1・5 が次の起動まで残る"},
        needs_fault},
    OpenQuestion{"restart_bits_stop",
                 {"0x1B.8, .9, .11 keep the motor off", "0x1B のビット 8・9・11 で出力 OFF になる"},
                 needs_fault},
    OpenQuestion{
        "boost_in_dead_band",
        {"0x2F pushes inside the dead band, too", "デッドバンド内でもブースト (0x2F) が働く"},
        needs_load},
    OpenQuestion{"pwm_end_points_move",
                 {"the ends of the pulse range are valid", "入力範囲の端のパルスが有効である"},
                 needs_pulses},
    OpenQuestion{
        "pwm_waits_after_start",
        {"no pulse counts for 0x27 after the start", "起動後 0x27 の間は PWM 入力が無効である"},
        needs_pulses},
    OpenQuestion{"pwm_yields_to_all",
                 {"PWM waits for 0x02 and 0x20, too", "0x02・0x20 でも PWM 入力が無効になる"},
                 needs_pulses},
    OpenQuestion{"output_write_ends_soft_start",
                 {"after 0x20 = on during a soft start the shaft runs on at full speed",
                  "ソフトスタート中の 0x20 = ON で、以後は全速で動作する"},
                 needs_motion},
    OpenQuestion{"soft_start_keeps_speed",
                 {"a speed during a soft start is accepted while 0x25 is off",
                  "0x25 が OFF でも、ソフトスタート中の速度指令が有効になる"},
                 needs_motion},
    OpenQuestion{"soft_start_resumes",
                 {"a soft start cut by a timeout goes on with the next command",
                  "タイムアウトで中断したソフトスタートが次の指令で再開する"},
                 needs_motion},
};

} // namespace

std::span<const OpenQuestion> open_questions() {
  return questions;
}

Notes::Notes() {
  for (const OpenQuestion& question : open_questions()) {
    facts_.push_back({.setting = question.setting,
                      .reason = std::string(choose(question.reason.en, question.reason.ja))});
  }
}

Fact& Notes::fact(std::string_view setting) {
  return *std::ranges::find(facts_, setting, &Fact::setting);
}

} // namespace blactl::fleet
