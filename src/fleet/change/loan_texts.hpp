#pragma once
// Messages about loans, which today are all of torque.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text loan_not_back{"node {}: torque was not put back: {}",
                                    "ノード {}: トルクを元に戻せませんでした: {}"};
inline constexpr Text loan_back_hint{"to put it back: blactl set {}={} -n {}",
                                     "元に戻すには: blactl set {}={} -n {}"};
inline constexpr Text loan_not_in_time{"interrupted", "中断されました"};
inline constexpr Text loan_changed{
    "node {}: {} is {} now, not as a moment ago: nothing was changed",
    "ノード {}: {} が直前の値から {} に変わっているため、何も変更していません"};
inline constexpr Text loan_differs{"{}, and was {} before", "{} (元の値: {})"};
inline constexpr Text loan_is{"node {}: {} is {} now", "ノード {}: {} は現在 {} です"};
inline constexpr Text loan_restarted{"node {} restarted meanwhile: {} is {} now",
                                     "ノード {} は途中で再起動しました。{} は現在 {} です"};
inline constexpr Text loan_of_another{"node {} is another servo now: its torque is left as it is",
                                      "ノード {} は別のサーボに替わったため、トルクは変更しません"};
inline constexpr Text loan_of_another_hint{"see what is there: blactl scan", "確認: blactl scan"};
inline constexpr Text loan_set_by_another{
    "node {}: node {} has written to it meanwhile: {} is {} now",
    "ノード {}: 途中でノード {} が書き込みました。{} は現在 {} です"};

} // namespace blactl::texts
