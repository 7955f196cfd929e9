#pragma once
// Messages about servos that must not leave a production line.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text unit_aside_hint{"put it aside", "ラインから外して下さい"};
inline constexpr Text unit_other_label{"its serial number is {}, the label says {}",
                                       "製造番号は {} です (ラベル: {})"};
inline constexpr Text unit_other_label_hint{"put it aside with its label: two were swapped",
                                            "ラベルの取違えがあります。ラベルとともに"
                                            "ラインから外して下さい"};
inline constexpr Text unit_faulty{"it has faults: {}", "異常があります: {}"};
inline constexpr Text unit_faulty_hint{"what they mean: blactl faults -n {}",
                                       "異常の内容: blactl faults -n {}"};

} // namespace blactl::texts
