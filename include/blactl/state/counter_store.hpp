#pragma once
// The IDs given permanently to the units of a production line, one after the other. Contract,
// section 6: IDs belong to a unique ID from their first assignment.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/state/access.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::state {

class StateFile;

/// A requested ID: the next one of a counter, or a given value.
struct IdWish {
  std::string parameter{};             ///< servo_id or static_node_id
  std::optional<std::int64_t> value{}; ///< from a label; the other members are then unused
  std::int64_t first = 0, last = 0;    ///< of a counter
  std::int64_t step = 1;               ///< 1 or more
  bool begins_again = false;           ///< after the last one, instead of ending
};

/// Given IDs, in `counters.db` of a folder: an SQLite database that several stations of a machine
/// use at once. When a function returns, its result is on disk. Each recipe has its own IDs. A lap
/// of a counter goes from its first to its last ID; within one no ID is given twice.
///
/// A file that is not ours or was made by a newer blactl is an error, and so is damage where it is
/// met (check_state_files() meets all of it). It stays as it is, byte for byte.
///
/// Errors of every function: bad_file (not a file of ours, damaged, of a newer blactl), permission,
/// io (also a full disk: then nothing has changed), busy (another process used it longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class CounterStore {
 public:
  /// `folder`: from state_folder(). Further errors: state: it is empty.
  [[nodiscard]] static Result<CounterStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty store that ends with this object.
  [[nodiscard]] static Result<CounterStore> unshared();

  /// Used by open() and unshared().
  explicit CounterStore(std::unique_ptr<StateFile> file);

  CounterStore(const CounterStore&) = delete;
  CounterStore& operator=(const CounterStore&) = delete;
  CounterStore(CounterStore&&) noexcept;
  CounterStore& operator=(CounterStore&&) noexcept;
  ~CounterStore();

  /// The IDs of this unit by this recipe, in the order of the wishes: those given to it before,
  /// whatever the counter is now; else the requested ones, given to it permanently: all or none. A
  /// counter gives first what was freed in its present lap, and then continues after its last ID;
  /// it skips those given by labels. Errors: counter_end; label_mismatch: a requested value is
  /// another unit's, or the unit has another.
  [[nodiscard]] Result<std::vector<std::int64_t>> assign(const dronecan::UniqueId& unique_id,
                                                         const std::string& recipe,
                                                         std::span<const IdWish> wishes,
                                                         WallTime now);

  /// The units that have an ID of this parameter by this recipe, in order.
  [[nodiscard]] Result<std::vector<dronecan::UniqueId>> units(const std::string& recipe,
                                                              const std::string& parameter) const;

  /// Whether there is a table: open() to read makes none.
  [[nodiscard]] bool is_there() const;

  /// Reads all of it. Errors: as check_state_files().
  [[nodiscard]] Result<void> check() const;

  /// Copies the whole table, of one moment, into a new file. Further errors: io: it cannot be
  /// written, or is there already; state: there is nothing to copy.
  [[nodiscard]] Result<void> back_up(const std::string& file) const;

  /// Frees what this unit has by this recipe: it is given to others, and the unit counts as new.
  [[nodiscard]] Result<void> free(const dronecan::UniqueId& unique_id, const std::string& recipe);

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
