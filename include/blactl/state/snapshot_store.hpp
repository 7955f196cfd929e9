#pragma once
// What servos held before they were changed: what `undo` goes back to.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/state/access.hpp"
#include "blactl/state/registers.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::state {

class StateFile;

/// One servo before the change that one command made.
struct SnapshotEntry {
  std::int64_t number = 0; ///< given by the store, ascending: the order of the changes; 0: new
  std::int64_t run = 0;  ///< the number of the first entry of its command; 0: of the first new one
  WallTime at{};         ///< when the change was about to begin
  std::string command{}; ///< "set"; from a file, so foreign bytes
  dronecan::UniqueId unique_id{};
  Registers held{};   ///< what the change replaces
  bool saved = false; ///< the change was saved to ROM; until it is settled, whether it will be
  bool ended = false; ///< all that its command was to do was done; else it may be half of that

  friend bool operator==(const SnapshotEntry&, const SnapshotEntry&) = default;
};

/// What became of the change of one servo.
enum class ChangeEnd : std::uint8_t {
  never_begun, ///< nothing was sent: its entry goes, and the change before it is the last one
  not_saved,
  saved
};

struct Settlement {
  std::int64_t number = 0; ///< of the entry
  ChangeEnd end = ChangeEnd::not_saved;
};

/// How many changes of one servo are kept, and for how long. The last one of a servo is kept for
/// ever.
inline constexpr std::size_t most_snapshots = 100;
inline constexpr std::chrono::days oldest_snapshot{365};

/// The changes of servos, in `snapshots.db` of a folder: an SQLite database that several processes
/// use at once. What a function has told is on the disk.
///
/// A file that is not ours, is damaged or was made by a newer blactl is an error and stays as it
/// is, byte for byte.
///
/// Errors of every function: bad_file (no file of ours, damaged, of a newer blactl), permission, io
/// (also a full disk: then nothing has changed), busy (another process wrote for longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class SnapshotStore {
 public:
  /// `folder`: what state_folder() said. Errors beside those of all: state: it is empty.
  [[nodiscard]] static Result<SnapshotStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty store that ends with this object.
  [[nodiscard]] static Result<SnapshotStore> unshared();

  /// As open() and unshared() make it.
  explicit SnapshotStore(std::unique_ptr<StateFile> file);

  SnapshotStore(const SnapshotStore&) = delete;
  SnapshotStore& operator=(const SnapshotStore&) = delete;
  SnapshotStore(SnapshotStore&&) noexcept;
  SnapshotStore& operator=(SnapshotStore&&) noexcept;
  ~SnapshotStore();

  /// Keeps all of them, or none; those that have a number are put in place of the entry of that
  /// number. What is too old or too much afterwards goes. Gives their numbers, in their order.
  [[nodiscard]] Result<std::vector<std::int64_t>> keep(std::span<const SnapshotEntry> entries,
                                                       WallTime now);

  /// Says of all of these entries what became of them, or of none.
  [[nodiscard]] Result<void> settle(std::span<const Settlement> settlements);

  /// The last changes of these units have ended, if they were made by this command.
  [[nodiscard]] Result<void> end(std::span<const dronecan::UniqueId> units,
                                 std::string_view command);

  /// The last change of this unit; empty: none is known.
  [[nodiscard]] Result<std::optional<SnapshotEntry>>
  last(const dronecan::UniqueId& unique_id) const;

  /// The change of the same unit before this one; empty: none is known.
  [[nodiscard]] Result<std::optional<SnapshotEntry>> before(const SnapshotEntry& entry) const;

  /// The changes that the last command made; empty: none is known.
  [[nodiscard]] Result<std::vector<SnapshotEntry>> last_run() const;

  /// All changes, the newest first.
  [[nodiscard]] Result<std::vector<SnapshotEntry>> entries() const;

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
