#pragma once
// Messages of `blactl command`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text motion_what{"command says nothing to do", "動作内容が指定されていません"};
inline constexpr Text motion_what_hint{
    "one of angle=45deg, speed=60rpm, torque=20%, or --wiggle",
    "angle=45deg、speed=60rpm、torque=20%、--wiggle のいずれかを指定して下さい"};
inline constexpr Text motion_both{"{} and --wiggle cannot both be done",
                                  "{} と --wiggle は同時に指定できません"};
inline constexpr Text motion_no_command{
    "{} is not a command: only angle, speed or torque is commanded",
    "{} は指令できません。指令できるのは angle、speed、torque のみです"};
inline constexpr Text motion_svg_to_stdout{"--svg: the drawing goes to a file only",
                                           "--svg の出力先はファイルのみです"};
inline constexpr Text motion_svg_hint{"for example --svg step.svg", "例: --svg step.svg"};
inline constexpr Text motion_drawn{"drawn into {}", "グラフを {} に出力しました"};
inline constexpr Text motion_ending{"bringing it to its end", "動作の終了処理中です"};
inline constexpr Text motion_left_hint{"it was commanded, and may still move: {}",
                                       "指令を送信済みです。まだ動作している可能性があります。{}"};
inline constexpr Text motion_interrupted_hint{"it was stopped: {}", "サーボを停止させました。{}"};

// The end.

inline constexpr Text motion_held{"node {}: held at {} (the shaft is at {})",
                                  "ノード {}: {} で保持しています (現在角度 {})"};
inline constexpr Text motion_loose{"node {}: the shaft is at {}, and nothing holds it",
                                   "ノード {}: 現在角度 {}、出力軸は保持されていません"};
inline constexpr Text motion_braked{
    "node {}: the shaft is at {}, and a brake alone holds it",
    "ノード {}: 現在角度 {}、出力軸はブレーキのみで保持されています"};
inline constexpr Text motion_settled{"reached after {} s, overshoot {}",
                                     "到達時間 {} 秒、オーバーシュート {}"};
inline constexpr Text motion_stopped{"node {}: stopped at {}", "ノード {}: {} で停止しました"};
inline constexpr Text motion_extremes{"fastest {}, most torque {}", "最高速度 {}、最大トルク {}"};

// The drawing.

inline constexpr Text motion_axis_angle{"angle [deg]", "角度 [deg]"};
inline constexpr Text motion_axis_speed{"speed [rpm]", "速度 [rpm]"};
inline constexpr Text motion_axis_torque{"torque [%]", "トルク [%]"};
inline constexpr Text motion_axis_time{"time [s]", "時間 [s]"};
inline constexpr Text motion_limits{"limits {}, {}", "制限 {}、{}"};
inline constexpr Text motion_legend{"dashed: the command; thin: the limits",
                                    "破線: 指令、細線: 制限"};

} // namespace blactl::texts
