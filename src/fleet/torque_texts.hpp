#pragma once
// What is said of servos that are let go and get their torque back.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text torque_not_back{"node {}: torque was not put back: {}",
                                      "ノード {}: トルクを元に戻せませんでした: {}"};
inline constexpr Text torque_back_hint{"to put it back: blactl set {}={} -n {}",
                                       "元に戻すには: blactl set {}={} -n {}"};
inline constexpr Text torque_not_in_time{"interrupted", "中断されました"};
inline constexpr Text torque_restarted{
    "node {} restarted meanwhile: its ROM decides about its torque, it is left as it is",
    "ノード {} は途中で再起動したため、トルクは ROM の設定に従います (変更しません)"};
inline constexpr Text torque_of_another{
    "node {} is another servo now: its torque is left as it is",
    "ノード {} は別のサーボに替わったため、トルクは変更しません"};
inline constexpr Text torque_set_by_another{
    "node {}: another node has set {} to {} meanwhile: it is left as it is",
    "ノード {}: 途中で別ノードが {} を {} に設定したため、変更しません"};

} // namespace blactl::texts
