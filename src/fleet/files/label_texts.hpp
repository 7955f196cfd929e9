#pragma once
// Messages about labels.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text label_line{"label {}", "ラベル {}"};
inline constexpr Text label_wrong{"label {}: '{}' is not a serial number",
                                  "ラベル {}: '{}' は製造番号ではありません"};
inline constexpr Text label_wrong_hint{
    "a line is a serial number, or an object such as {{\"serial_number\": 240900558}}",
    "1 行に製造番号、または {{\"serial_number\": 240900558}} のようなオブジェクトを入力して下さい"};

} // namespace blactl::texts
