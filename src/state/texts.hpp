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
    "いずれかの終了を待つか、空いている ID を --local-node-id で指定して下さい",
};
inline constexpr Text lock_files_block_hint{
    "see whose the files are with `ls -ld {0}/*`; once no blactl runs they can be removed",
    "`ls -ld {0}/*` で所有者を確認して下さい。blactl が動作していなければ削除できます",
};
inline constexpr Text node_id_held_by{"{} is held by process {}", "{} はプロセス {} が使用中"};
inline constexpr Text node_id_held{"{} is held by another process", "{} は別のプロセスが使用中"};
inline constexpr Text node_id_foreign{"{} is used by another node", "{} は別のノードが使用中"};
inline constexpr Text node_id_was_foreign{"{} was used by another node before",
                                          "{} は以前に別のノードが使用"};
inline constexpr Text own_id_in_use{"node ID {} is used by another node on {}",
                                    "ノード ID {} は {} 上の別のノードが使用しています"};
inline constexpr Text own_id_in_use_hint{
    "give a free node ID: --local-node-id ID",
    "空いているノード ID を指定して下さい: --local-node-id ID"};
inline constexpr Text node_id_lock_failed{"{}: {} cannot be opened ({})",
                                          "{}: {} を開けません ({})"};

inline constexpr Text writing_held{"process {1} is writing to servos on {0}",
                                   "プロセス {1} が {0} でサーボに書込み中です"};
inline constexpr Text allocating_held{"process {1} allocates node IDs on {0}",
                                      "プロセス {1} が {0} でノード ID を割当て中です"};
inline constexpr Text unknown_process{"?", "?"};
inline constexpr Text lock_held_hint{"wait until it ends", "その終了を待って下さい"};
inline constexpr Text lock_failed{"the lock file {} cannot be opened ({})",
                                  "ロックファイル {} を開けません ({})"};
inline constexpr Text lock_failed_hint{
    "see whose it is with `ls -ld {0}`; once no blactl runs it can be removed",
    "`ls -ld {0}` で所有者を確認して下さい。blactl が動作していなければ削除できます"};

} // namespace blactl::texts
