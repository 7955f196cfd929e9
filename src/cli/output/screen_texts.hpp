#pragma once
// Messages about terminals.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text screen_unknown{"nothing is known of the terminal '{}' (TERM)",
                                     "端末 '{}' (TERM) の情報がありません"};
inline constexpr Text screen_without_cursor{
    "the terminal '{}' (TERM) cannot place its cursor: a table needs that",
    "端末 '{}' (TERM) はカーソル位置を指定できないため、表を表示できません"};
inline constexpr Text screen_hint{"set TERM to the type of the terminal, for example: TERM=xterm",
                                  "端末の種類を指定して下さい (例: TERM=xterm)"};

} // namespace blactl::texts
