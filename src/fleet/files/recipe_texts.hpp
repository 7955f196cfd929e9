#pragma once
// Messages about recipes.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text recipe_counter_of{
    "{} is not an ID: only servo_id and static_node_id are counted",
    "{} は ID ではありません。カウンターは servo_id と static_node_id のみに指定できます"};
inline constexpr Text recipe_counter_ends{"\"last\" is {}, below \"first\", {}",
                                          "\"last\" ({}) が \"first\" ({}) より小さい値です"};

} // namespace blactl::texts
