#pragma once
// The ledger of a production line: one permanent record for every servo at a station.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/state/access.hpp"
#include "blactl/state/ledger_record.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace blactl::state {

class StateFile;

/// Selects the records that match all given criteria.
struct LedgerQuery {
  std::optional<WallTime> since{}; ///< inclusive; whole seconds
  std::optional<WallTime> until{}; ///< exclusive
  std::optional<std::int64_t> serial_number{};
  std::optional<std::string> verdict{}, work_order{}, station{}, unique_id{}, recipe{}, record_id{};
};

/// Records of a station that are missing: from the first to the last number.
struct LedgerHole {
  std::string station;
  std::int64_t first = 0, last = 0;

  friend bool operator==(const LedgerHole&, const LedgerHole&) = default;
};

/// The IDs with which a unit has passed.
struct PassedIds {
  std::optional<std::int64_t> servo_id{}, static_node_id{};

  friend bool operator==(const PassedIds&, const PassedIds&) = default;
};

/// Records in `ledger.db` of a folder: an SQLite database that several stations of a machine use at
/// once. When a function returns, its result is on disk. Records are never changed or removed. What
/// is begun is kept apart until it has ended.
///
/// A file that is not ours or was made by a newer blactl is an error, and so is damage where it is
/// met (check_state_files() meets all of it). It stays as it is, byte for byte.
///
/// Errors of every function: bad_file (not a file of ours, damaged, of a newer blactl), permission,
/// io (also a full disk: then nothing has changed), busy (another process used it longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class LedgerStore {
 public:
  /// `folder`: from state_folder(). Further errors: state: it is empty.
  [[nodiscard]] static Result<LedgerStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty ledger that ends with this object.
  [[nodiscard]] static Result<LedgerStore> unshared();

  /// Used by open() and unshared().
  explicit LedgerStore(std::unique_ptr<StateFile> file);

  LedgerStore(const LedgerStore&) = delete;
  LedgerStore& operator=(const LedgerStore&) = delete;
  LedgerStore(LedgerStore&&) noexcept;
  LedgerStore& operator=(LedgerStore&&) noexcept;
  ~LedgerStore();

  /// Keeps a record that has a record_id, a time and a station, and no verdict yet. Further errors:
  /// state: this record_id is known.
  [[nodiscard]] Result<void> begin(const LedgerRecord& record);

  /// Adds a record, which has a record_id, a time, a station and a verdict, with the next number of
  /// its station; it may have begun before. Adding the same again changes nothing: a sender may
  /// repeat a record if it cannot know whether it arrived. Returns the number. Further errors:
  /// state: a different record has its record_id.
  [[nodiscard]] Result<std::int64_t> end(const LedgerRecord& record);

  /// What has begun and not ended; of one station, or of all.
  [[nodiscard]] Result<std::vector<LedgerRecord>>
  begun(const std::optional<std::string>& station = {}) const;

  /// Whether there is a ledger: open() to read makes none.
  [[nodiscard]] bool is_there() const;

  /// The holes in the numbers of all stations. Further errors: as check_state_files().
  [[nodiscard]] Result<std::vector<LedgerHole>> holes() const;

  /// Copies the whole ledger, of one moment, into a new file. Further errors: io: it cannot be
  /// written, or is there already.
  [[nodiscard]] Result<void> back_up(const std::string& file) const;

  /// Calls `take` for each record, in the order of addition, until it returns false. Others may add
  /// records meanwhile, which come too.
  [[nodiscard]] Result<void> each(const LedgerQuery& query,
                                  const std::function<bool(const LedgerRecord&)>& take) const;

  /// The units that have passed by this recipe, and were not scrapped since, by unique ID as in the
  /// records; with the IDs of their last pass. For ledgers of any length: no record is read as a
  /// whole.
  [[nodiscard]] Result<std::map<std::string, PassedIds>> passed(const std::string& recipe) const;

  /// The path of its file, even if that does not exist yet; empty: it has none.
  [[nodiscard]] const std::string& path() const;

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
