#pragma once
// The catalogue of the floor state.

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

inline constexpr Text writing_held{"process {1} is writing to servos on {0}",
                                   "プロセス {1} が {0} でサーボに書込み中です"};
inline constexpr Text allocating_held{"process {1} allocates node IDs on {0}",
                                      "プロセス {1} が {0} でノード ID を割当て中です"};
inline constexpr Text unknown_process{"?", "?"};
inline constexpr Text lock_held_hint{"wait until it ends", "その終了を待ってください"};
inline constexpr Text lock_failed{"{} cannot be opened ({})", "{} を開けません ({})"};

} // namespace blactl::texts
