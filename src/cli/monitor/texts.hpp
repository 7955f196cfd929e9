#pragma once
// Messages on the screen of monitor.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text monitor_title{"blactl monitor  {}  servos: {}",
                                    "blactl monitor  {}  サーボ: {} 台"};
inline constexpr Text monitor_paused{"paused", "一時停止中"};
inline constexpr Text monitor_sorted{"by {}", "{}順"};
inline constexpr Text monitor_waiting{"no servo was heard yet", "サーボをまだ受信していません"};
inline constexpr Text monitor_rows{"{}-{} of {}", "{}～{} / {}"};
inline constexpr Text monitor_keys{"q quit   Enter graphs   s sort   p pause   ? help",
                                   "q 終了   Enter グラフ   s 並べ替え   p 一時停止   ? ヘルプ"};
inline constexpr Text monitor_keys_log{
    "q quit   Enter graphs   s sort   p pause   + - faster, slower   ? help",
    "q 終了   Enter グラフ   s 並べ替え   p 一時停止   + - 再生速度   ? ヘルプ"};
inline constexpr Text monitor_keys_one{"q quit   Esc table   p pause   ? help",
                                       "q 終了   Esc 一覧   p 一時停止   ? ヘルプ"};

inline constexpr Text monitor_angle{"ANGLE", "角度"};
inline constexpr Text monitor_speed{"SPEED", "速度"};
inline constexpr Text monitor_torque{"TORQUE", "トルク"};
inline constexpr Text monitor_temperature{"TEMP", "温度"};
inline constexpr Text monitor_voltage{"VOLTAGE", "電圧"};
inline constexpr Text monitor_age{"AGE", "経過"};
inline constexpr Text monitor_time{"TIME", "時刻"};
inline constexpr Text state_stale{"stale", "更新なし"};

inline constexpr Text state_gone{"not heard for {} s", "{} 秒間受信なし"};
inline constexpr Text state_doubled{"two units use this ID", "ID 重複 (2 台)"};
inline constexpr Text state_restarts{"restarts: {}", "再起動: {} 回"};
inline constexpr Text state_former{"was node {}", "旧ノード {}"};
inline constexpr Text state_turned{"<< TURNED", "<< 回転検出"};
inline constexpr Text state_new{"new", "新規"};
inline constexpr Text state_more{"+{}", "他 {}"};
inline constexpr Text state_unknown_fault{"{} bit {}", "{} ビット {}"};

inline constexpr Text monitor_played{"log: {} s", "ログ: {} 秒"};
inline constexpr Text monitor_played_faster{"{} times faster", "{} 倍速"};
inline constexpr Text monitor_played_slower{"{} times slower", "1/{} 倍速"};
inline constexpr Text monitor_played_out{"end of the log", "ログの終わり"};
inline constexpr Text monitor_gone{"interface gone: waiting", "インターフェース切断: 復帰待ち"};
inline constexpr Text monitor_away{"{}: waiting for it", "{}。復帰を待っています"};
inline constexpr Text monitor_back{"{} is back", "{} が復帰しました"};
inline constexpr Text monitor_identifies{"turn a horn by hand", "手で回して下さい"};
inline constexpr Text monitor_holding{", not of {}", " ({} を除く)"};
inline constexpr Text moved_unwatched{"whether a servo moved is watched with --identify only",
                                      "moved は --identify 指定時のみ使用できます"};
inline constexpr Text moved_unwatched_hint{
    "add --identify, or leave moved out of --fields",
    "--identify を付けるか、--fields から moved を外して下さい"};

inline constexpr Text identify_question{
    "They have no torque until the command ends, then it comes back.\n",
    "このコマンドの終了まで上記サーボのトルクが OFF になり、終了時に元に戻ります。\n"};
inline constexpr Text identify_begun{
    "torque is off, servos: {} ({}). Turn a horn by hand",
    "サーボ {} 台 ({}) のトルクを OFF にしました。ホーンを手で回して下さい"};
inline constexpr Text identify_nothing{"no servo had torque: nothing was changed",
                                       "トルク ON のサーボがないため、何も変更していません"};
inline constexpr Text identify_back{"Torque comes back, servos: {} ({}). Hands off.",
                                    "サーボ {} 台 ({}) のトルクが元に戻ります。手を離して下さい。"};
inline constexpr Text identify_enter{" Enter: ", " Enter で続行: "};
inline constexpr Text identify_in_time{" 10 s at most (Ctrl-C again: not at all)",
                                       " 最大 10 秒 (もう一度 Ctrl-C を押すと元に戻しません)"};
inline constexpr Text identify_done{"torque is as it was before, servos: {} ({})",
                                    "サーボ {} 台 ({}) のトルクは元の状態に戻りました"};
inline constexpr Text identify_done_hint{"no torque is left off by this command",
                                         "このコマンドで OFF にしたトルクは残っていません"};
inline constexpr Text identify_not_done_hint{"see below whose torque was not put back",
                                             "トルクを元に戻せなかったサーボは次の通りです"};

inline constexpr Text sort_node{"node ID", "ノード ID"};
inline constexpr Text sort_state{"state", "状態"};
inline constexpr Text sort_angle{"angle", "角度"};
inline constexpr Text sort_temperature{"temperature", "温度"};
inline constexpr Text sort_voltage{"voltage", "電圧"};

inline constexpr Text monitor_help{
    "q, Ctrl-C      end\n"
    "Up, Down, k, j choose a servo; PgUp, PgDn, Home, End go further\n"
    "Enter          graphs of the chosen servo: the last 60 s\n"
    "Esc, Backspace back to the table\n"
    "s              sort by node ID, state, angle, temperature, voltage\n"
    "p, Space       pause: what is shown stays, servos are still heard; a log stops\n"
    "+, -           a log is played faster, slower\n"
    "?              this help",
    "q、Ctrl-C      終了\n"
    "↑、↓、k、j     サーボを選択 (PgUp、PgDn、Home、End で大きく移動)\n"
    "Enter          選択したサーボのグラフ (直近 60 秒)\n"
    "Esc、Backspace 一覧に戻る\n"
    "s              並べ替え (ノード ID、状態、角度、温度、電圧)\n"
    "p、スペース    一時停止 (表示を保持、受信は継続。ログは再生停止)\n"
    "+、-           ログの再生速度を上げる、下げる\n"
    "?              このヘルプ"};

inline constexpr Text graph_range{"last {} s   now {}   min {}   max {}",
                                  "直近 {} 秒   現在 {}   最小 {}   最大 {}"};
inline constexpr Text graph_empty{"nothing was heard of it yet", "まだ受信していません"};
inline constexpr Text monitor_other_screen{"{}: lines instead", "{}。行形式で表示します"};

} // namespace blactl::texts
