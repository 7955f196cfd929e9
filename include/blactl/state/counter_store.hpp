#pragma once
// Which IDs the units of a production line were given, one after the other, for good.
// Contract, section 6: IDs belong to a unique ID from their first assignment.

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

/// An ID that is wished for a unit: the next one of a counter, or just this one.
struct IdWish {
  std::string parameter{};             ///< servo_id or static_node_id
  std::optional<std::int64_t> value{}; ///< as a label says; then what follows is not looked at
  std::int64_t first = 0, last = 0;    ///< of a counter
  std::int64_t step = 1;               ///< 1 or more
  bool begins_again = false;           ///< after the last one; else that is the end
};

/// Given IDs, in `counters.db` of a folder: an SQLite database that several stations of a machine
/// use at once. What a function has told is on the disk. Each recipe has IDs of its own.
///
/// A file that is not ours, is damaged or was made by a newer blactl is an error and stays as it
/// is, byte for byte.
///
/// Errors of every function: bad_file (no file of ours, damaged, of a newer blactl), permission, io
/// (also a full disk: then nothing has changed), busy (another process wrote for longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class CounterStore {
 public:
  /// `folder`: what state_folder() said. Errors beside those of all: state: it is empty.
  [[nodiscard]] static Result<CounterStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty store that ends with this object.
  [[nodiscard]] static Result<CounterStore> unshared();

  /// As open() and unshared() make it.
  explicit CounterStore(std::unique_ptr<StateFile> file);

  CounterStore(const CounterStore&) = delete;
  CounterStore& operator=(const CounterStore&) = delete;
  CounterStore(CounterStore&&) noexcept;
  CounterStore& operator=(CounterStore&&) noexcept;
  ~CounterStore();

  /// The IDs of this unit by this recipe, in the order of the wishes: those that it was given
  /// before, whatever the counter is by now; else those that are wished, given to it from now on:
  /// all of them, or none. A counter goes on behind the ID that it gave last, and passes over what
  /// a label has given, unless it begins again: then IDs are given more than once.
  /// Errors: counter_end; label_mismatch: a wished value is another unit's, or the unit has
  /// another.
  [[nodiscard]] Result<std::vector<std::int64_t>> assign(const dronecan::UniqueId& unique_id,
                                                         const std::string& recipe,
                                                         std::span<const IdWish> wishes,
                                                         WallTime now);

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
