#pragma once
// Messages about a change as a whole, before it.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text came_since{
    "node {} has come to the bus since the servos were looked for: nothing was written",
    "サーボの検索後にノード {} がバスに加わったため、書込みを行っていません"};
inline constexpr Text did_not_tell_ids{
    "node {} did not say which IDs it has: a conflict with it cannot be ruled out",
    "ノード {} の ID を読み出せないため、重複の有無は確認できません"};
inline constexpr Text will_make_way{
    "node {} makes way for others: it is saved twice, node ID {} comes in between",
    "ノード {} は ID 入替えのため一時的にノード ID {} を使用します (保存は 2 回)"};
inline constexpr Text id_taken_over{
    "node ID {} was given to uid:{}, which is not on this bus: it is node {}'s from now on",
    "ノード ID {} の割当て先 uid:{} はこのバスにないため、ノード {} に割り当てます"};

} // namespace blactl::texts
