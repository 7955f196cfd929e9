#pragma once
// The settings of servos before changes, to which `undo` returns.

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

/// One servo before the change by one command.
struct SnapshotEntry {
  std::int64_t number = 0; ///< given by the store, ascending: the order of the changes; 0: new
  std::int64_t run = 0;  ///< the number of the first entry of its command; 0: of the first new one
  WallTime at{};         ///< just before the change
  std::string command{}; ///< "set"; from a file, so foreign bytes
  dronecan::UniqueId unique_id{};
  Registers held{};    ///< the values that the change replaces
  Registers written{}; ///< those that it writes in their place, as far as it names them
  bool saved = false;  ///< saved to ROM; until settled, whether it is to be saved
  bool ended = false;  ///< its command was completed; else perhaps only in part
  std::optional<WallTime> settled{}; ///< when its outcome was known; empty: not yet, or never
  /// As RomProof::clock, at `at`. Empty: not known, or of an earlier run of this machine.
  std::optional<WallTime> clock{};
  /// Of the unit: one with another number is another unit. Empty: it did not tell it.
  std::optional<std::int64_t> serial_number{};

  friend bool operator==(const SnapshotEntry&, const SnapshotEntry&) = default;
};

/// The outcome of the change of one servo.
enum class ChangeEnd : std::uint8_t {
  never_begun, ///< nothing was sent: its entry is removed, and the change before it is the last one
  not_saved,
  saved
};

struct Settlement {
  std::int64_t number = 0; ///< of the entry
  ChangeEnd end = ChangeEnd::not_saved;
  WallTime at{}; ///< now; unused for one that was never begun
};

/// How many changes of one servo are kept, and for how long. The last one of a servo is always
/// kept, with the tries that it continues.
inline constexpr std::size_t most_snapshots = 100;
inline constexpr std::chrono::days oldest_snapshot{365};

/// The changes of servos, in `snapshots.db` of a folder: an SQLite database that several processes
/// use at once. When a function returns, its result is on disk.
///
/// A file that is not ours or was made by a newer blactl is an error, and so is damage where it is
/// met (check_state_files() meets all of it). It stays as it is, byte for byte.
///
/// Errors of every function: bad_file (not a file of ours, damaged, of a newer blactl), permission,
/// io (also a full disk: then nothing has changed), busy (another process used it longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class SnapshotStore {
 public:
  /// `folder`: from state_folder(). Further errors: state: it is empty.
  [[nodiscard]] static Result<SnapshotStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty store that ends with this object.
  [[nodiscard]] static Result<SnapshotStore> unshared();

  /// Used by open() and unshared().
  explicit SnapshotStore(std::unique_ptr<StateFile> file);

  SnapshotStore(const SnapshotStore&) = delete;
  SnapshotStore& operator=(const SnapshotStore&) = delete;
  SnapshotStore(SnapshotStore&&) noexcept;
  SnapshotStore& operator=(SnapshotStore&&) noexcept;
  ~SnapshotStore();

  /// Stores all entries or none; those with a number replace the entry of that number. Removes
  /// those with the numbers `former`: new ones take their places as the last changes of their
  /// servos. Then drops entries that are too old or too many. Returns the numbers, in order.
  [[nodiscard]] Result<std::vector<std::int64_t>> keep(std::span<const SnapshotEntry> entries,
                                                       WallTime now,
                                                       std::span<const std::int64_t> former = {});

  /// Records the outcome of these entries: all or none.
  [[nodiscard]] Result<void> settle(std::span<const Settlement> settlements);

  /// Marks the last changes of these units, with the earlier tries that they continue, as ended, if
  /// this command made them.
  [[nodiscard]] Result<void> end(std::span<const dronecan::UniqueId> units,
                                 std::string_view command);

  /// The last change of this unit; empty: none. Without a serial number: of any with this unique
  /// ID.
  [[nodiscard]] Result<std::optional<SnapshotEntry>>
  last(const dronecan::UniqueId& unique_id,
       std::optional<std::int64_t> serial_number = std::nullopt) const;

  /// The change of the same unit before this one; empty: none.
  [[nodiscard]] Result<std::optional<SnapshotEntry>> before(const SnapshotEntry& entry) const;

  /// The changes made by the last command; empty: none.
  [[nodiscard]] Result<std::vector<SnapshotEntry>> last_run() const;

  /// All changes, the newest first.
  [[nodiscard]] Result<std::vector<SnapshotEntry>> entries() const;

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
