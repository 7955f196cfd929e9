#pragma once
// The catalogue of the floor dronecan.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text no_local_node_id{
    "no node ID is free for this process on {}: {}",
    "{} でこのプロセスが使えるノード ID が空いていません: {}",
};
inline constexpr Text no_local_node_id_hint{
    "wait until one of them ends, or give a free ID with --local-node-id",
    "いずれかの終了を待つか、空いている ID を --local-node-id で指定してください",
};
inline constexpr Text node_id_held_by{"{} is held by process {}", "{} はプロセス {} が使用中"};
inline constexpr Text node_id_held{"{} is held by another process", "{} は別のプロセスが使用中"};
inline constexpr Text node_id_lock_failed{"{}: {} cannot be opened ({})",
                                          "{}: {} を開けません ({})"};

} // namespace blactl::texts
