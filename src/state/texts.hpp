#pragma once
// The text catalogue of the floor `state`.

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
    "give a free node ID: --local-node-id ID; if {0} is a servo, give it another one for good: "
    "blactl --local-node-id ID set -n {0} static_node_id=N --save",
    "空いているノード ID を指定して下さい: --local-node-id ID。{0} がサーボの場合は、"
    "別のノード ID に変更: blactl --local-node-id ID set -n {0} static_node_id=N --save"};
inline constexpr Text node_id_lock_failed{"{}: {} cannot be opened ({})",
                                          "{}: {} を開けません ({})"};

inline constexpr Text writing_held{"process {1} is writing to servos on {0}",
                                   "プロセス {1} が {0} でサーボに書込み中です"};
inline constexpr Text allocating_held{"process {1} allocates node IDs on {0}",
                                      "プロセス {1} が {0} でノード ID を割当て中です"};
inline constexpr Text unknown_process{"?", "?"};
inline constexpr Text station_held{"another run of blactl is the station {}",
                                   "ステーション {} は別の blactl が動作中です"};
inline constexpr Text station_held_hint{
    "give each station a name of its own: --station NAME",
    "ステーションごとに別の名前を指定して下さい: --station NAME"};
inline constexpr Text lock_held_hint{"wait until it ends", "その終了を待って下さい"};
inline constexpr Text lock_failed{"the lock file {} cannot be opened ({})",
                                  "ロックファイル {} を開けません ({})"};
inline constexpr Text lock_failed_hint{
    "see whose it is with `ls -ld {0}`; once no blactl runs it can be removed",
    "`ls -ld {0}` で所有者を確認して下さい。blactl が動作していなければ削除できます"};

inline constexpr Text no_state_folder{
    "blactl has no folder to keep its state in: BLACTL_STATE_DIR and HOME are not set",
    "blactl の状態を保存するフォルダがありません (BLACTL_STATE_DIR も HOME も未設定です)"};
inline constexpr Text state_folder_closed{
    "{} is not writable: allocations cannot be kept there",
    "{} に書き込めません。ノード ID の割当てを保存できません"};
inline constexpr Text state_folder_full{
    "{} has no room left: allocations cannot be kept there",
    "{} に空き容量がありません。ノード ID の割当てを保存できません"};
inline constexpr Text state_folder_full_hint{"see what fills the disk with `df {0}`",
                                             "`df {0}` で空き容量を確認して下さい"};
inline constexpr Text state_on_network{
    "{0} is on a file system of another machine: the {1} would not be safe there",
    "{0} はネットワーク上のファイルシステムです。{1}を安全に保存できません"};
inline constexpr Text state_on_network_hint{
    "set BLACTL_STATE_DIR to a folder on a disk of this machine",
    "BLACTL_STATE_DIR にこのコンピューターのディスク上のフォルダを設定して下さい"};
inline constexpr Text no_state_folder_hint{"set BLACTL_STATE_DIR to a folder of your own",
                                           "BLACTL_STATE_DIR に自分のフォルダを設定して下さい"};
inline constexpr Text table_foreign{"{0} is not a blactl {1}", "{0} は blactl の{1}ではありません"};
inline constexpr Text table_is_link{"{} is a symbolic link, which is not followed",
                                    "{} はシンボリックリンクのため使用できません"};
inline constexpr Text table_left_over{"{0} is left over from another {1}",
                                      "{0} は別の{1}の残りです"};
inline constexpr Text table_damaged{"the {1} {0} is damaged ({2})", "{1} {0} が壊れています ({2})"};
inline constexpr Text table_unusable_hint{
    "it was left as it is; move it away with `mv {0}* FOLDER`, then {1}",
    "ファイルは変更していません。`mv {0}* フォルダ` で移動して下さい。{1}"};
inline constexpr Text table_newer{
    "the {1} {0} has version {2}; this blactl knows version {3} at most",
    "{1} {0} のバージョンは {2} です。この blactl はバージョン {3} までに対応しています"};
inline constexpr Text table_newer_hint{
    "update blactl; or move the file away with `mv {0}* FOLDER`, then {1}",
    "blactl を更新するか、`mv {0}* フォルダ` でファイルを移動して下さい。{1}"};
inline constexpr Text allocation_table{"allocation table", "割当て表"};
inline constexpr Text allocation_table_back{
    "bring in what you exported with `blactl alloc --import FILE`",
    "エクスポートした表は `blactl alloc --import ファイル` で取り込めます"};
inline constexpr Text rom_record{"record of ROM contents", "ROM 照合記録"};
inline constexpr Text rom_record_back{
    "a new one is started: `blactl apply` restarts servos once to see what their ROM holds",
    "記録は新しく作成されます (ROM の内容は次回の `blactl apply` が再起動して確認します)"};
inline constexpr Text change_history{"change history", "変更履歴"};
inline constexpr Text change_history_back{
    "a new one is started; `blactl undo` cannot revert the changes in the old one",
    "履歴は新しく作成されます (これまでの変更は `blactl undo` で戻せなくなります)"};
inline constexpr Text ledger{"ledger", "製造記録"};
inline constexpr Text ledger_back{
    "a new one is started; servos finished in the old one would be processed again",
    "製造記録は新しく作成されます (この記録で完了したサーボは再度処理されます)"};
inline constexpr Text nothing_to_copy{"there is nothing to copy: {} does not exist",
                                      "コピーする記録がありません ({} が存在しません)"};
inline constexpr Text nothing_to_copy_hint{
    "it is made by the first `blactl provision`; BLACTL_STATE_DIR tells where it is looked for",
    "記録は最初の `blactl provision` で作成されます。場所は BLACTL_STATE_DIR で指定します"};
inline constexpr Text ledger_twice{"another record of the ledger has the record_id {}",
                                   "record_id {} の製造記録が既に存在します"};
inline constexpr Text counters{"table of assigned IDs", "採番表"};
inline constexpr Text counters_back{
    "put back its backup (blactl ledger --backup); a new one is started, and by a recipe whose "
    "servos "
    "have passed already nothing is numbered then: give that a new name, and counters that begin "
    "after the IDs in `blactl ledger`",
    "バックアップ (blactl ledger --backup) を戻して下さい。採番表は新しく作成されますが、合格した"
    "サーボがあるレシピは使えなくなります。その場合はレシピの名前を変え、`blactl ledger` に"
    "ある ID の次からカウンターを始めて下さい"};
inline constexpr Text counter_ended{"the counter of {} in the recipe {} is at its end, {}",
                                    "レシピ {1} の {0} のカウンターは終了値 {2} に達しました"};
inline constexpr Text counter_ended_hint{"give it more room: raise \"last\" in the recipe",
                                         "レシピの \"last\" を大きくして下さい"};
inline constexpr Text counter_taken{"{} {} was given to another servo before: unique ID {}",
                                    "{} {} は別のサーボ (固有 ID {}) に割当て済みです"};
inline constexpr Text counter_other{"this servo was given {} {} before, not {}",
                                    "このサーボには {} {} が割当て済みです ({} ではありません)"};
inline constexpr Text counter_taken_hint{
    "check the label; IDs once given do not change",
    "ラベルを確認して下さい。割当て済みの ID は変更されません"};
inline constexpr Text table_moved{"the {1} {0} was moved away or removed while it was in use",
                                  "{1} {0} が使用中に移動または削除されました"};
inline constexpr Text table_moved_hint{"nothing was changed; run the command again",
                                       "何も変更していません。コマンドをもう一度実行して下さい"};
inline constexpr Text table_busy{"another process is using the {1} {0}",
                                 "別のプロセスが{1} {0} を使用中です"};
inline constexpr Text table_busy_hint{
    "wait until it ends and try again; `fuser {0}` shows which one it is",
    "その終了を待って、もう一度実行して下さい。プロセスは `fuser {0}` で確認できます"};
inline constexpr Text table_denied{"the {1} {0} cannot be used ({2})",
                                   "{1} {0} を使用できません ({2})"};
inline constexpr Text table_denied_hint{
    "check the permissions with `ls -la {0}`, or set BLACTL_STATE_DIR to a folder of your own",
    "`ls -la {0}` でアクセス権を確認するか、BLACTL_STATE_DIR に自分のフォルダを設定して下さい"};
inline constexpr Text table_broken_off{
    "the last write to the {1} {0} was broken off and cannot be taken back ({2})",
    "{1} {0} への書込みが中断されており、元に戻せません ({2})"};
inline constexpr Text table_io{"the {1} {0} cannot be read or written ({2})",
                               "{1} {0} を読み書きできません ({2})"};
inline constexpr Text table_io_hint{
    "nothing was changed; check the disk and its free space with `df {0}`",
    "何も変更していません。`df {0}` でディスクとその空き容量を確認して下さい"};
inline constexpr Text table_full{"nodes on the bus have all node IDs from {} to {}",
                                 "ノード ID {}～{} はすべてバス上のノードが使用しています"};
inline constexpr Text table_full_hint{"give a wider --range", "--range を広げて下さい"};
inline constexpr Text node_id_given{"node ID {} belongs to the unique ID {}",
                                    "ノード ID {} は固有 ID {} に割当て済みです"};
inline constexpr Text node_id_given_hint{
    "choose another one, or give it up first with `blactl alloc --forget {}`",
    "別のノード ID を指定するか、先に `blactl alloc --forget {}` で解放して下さい"};
inline constexpr Text node_id_not_dynamic{"node ID {} cannot be allocated",
                                          "ノード ID {} は割り当てられません"};
inline constexpr Text node_id_not_dynamic_hint{
    "give an ID from 1 to 125; 126 and 127 are for tools",
    "1～125 を指定して下さい。126 と 127 はツール用です"};

inline constexpr Text no_unique_id{"not a unique ID: 32 hexadecimal digits, not all of them 0",
                                   "固有 ID ではありません (16 進数 32 桁、すべて 0 は不可)"};
inline constexpr Text no_time{"not a time of RFC 3339, such as 2026-11-21T08:15:00Z",
                              "RFC 3339 形式の日時ではありません (例: 2026-11-21T08:15:00Z)"};
inline constexpr Text unit_twice{"this unique ID occurs twice", "この固有 ID は重複しています"};
inline constexpr Text node_id_twice{"this node ID occurs twice", "このノード ID は重複しています"};

} // namespace blactl::texts
