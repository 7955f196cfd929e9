#pragma once
// Messages of `blactl sim`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

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
inline constexpr Text sim_behind{
    "the simulated bus is {} s late: this machine is too slow for it, or did not run the simulator",
    "模擬バスが {} 秒遅れています。処理が追いつかないか、シミュレータが停止していました"};
inline constexpr Text sim_events_dropped{
    "events that nobody read in time and that are not printed: {}",
    "読み取られなかったため出力していないイベント: {}"};
inline constexpr Text scenario_is_argument{"-i {}: a scenario is an argument of sim",
                                           "-i {}: シナリオは sim の引数で指定します"};
inline constexpr Text scenario_is_argument_hint{"blactl sim {}", "blactl sim {}"};

} // namespace blactl::texts
