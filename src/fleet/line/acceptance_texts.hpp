#pragma once
// Messages about servos that must not leave a production line.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text unit_of_other_model{"it is a {}, the recipe is for {}",
                                          "機種は {} です (レシピの機種: {})"};
inline constexpr Text unit_of_unknown_model{"unknown model", "不明な機種"};
inline constexpr Text unit_aside_hint{"put it aside", "ラインから外して下さい"};
inline constexpr Text unit_too_old{"its firmware is {}, the recipe needs {} or later",
                                   "ファームウェアは {} です (レシピの条件: {} 以降)"};
inline constexpr Text unit_too_old_hint{"have its firmware updated",
                                        "ファームウェアを更新して下さい"};
inline constexpr Text unit_other_label{"its serial number is {}, the label says {}",
                                       "製造番号は {} です (ラベル: {})"};
inline constexpr Text unit_other_label_hint{"put it aside with its label: two were swapped",
                                            "ラベルの取違えがあります。ラベルとともに"
                                            "ラインから外して下さい"};
inline constexpr Text unit_silent{"it did not report its {}", "{} の応答がありません"};
inline constexpr Text unit_faulty{"it has faults: {}", "異常があります: {}"};
inline constexpr Text unit_faulty_hint{"what they mean: blactl faults -n {}",
                                       "異常の内容: blactl faults -n {}"};

} // namespace blactl::texts
