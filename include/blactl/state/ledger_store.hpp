#pragma once
// The ledger of a production line: one record for every servo that came to a station, for good.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/state/access.hpp"
#include "blactl/state/ledger_record.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace blactl::state {

class StateFile;

/// Which records are meant: those for which all that is given holds.
struct LedgerQuery {
  std::optional<WallTime> since{}; ///< that moment included; whole seconds
  std::optional<WallTime> until{}; ///< not included
  std::optional<std::int64_t> serial_number{};
  std::optional<std::string> verdict{}, work_order{}, unique_id{}, recipe{};
};

/// Records in `ledger.db` of a folder: an SQLite database that several stations of a machine use at
/// once. What a function has told is on the disk. Nothing is changed or removed ever.
///
/// A file that is not ours, is damaged or was made by a newer blactl is an error and stays as it
/// is, byte for byte.
///
/// Errors of every function: bad_file (no file of ours, damaged, of a newer blactl), permission, io
/// (also a full disk: then nothing has changed), busy (another process wrote for longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class LedgerStore {
 public:
  /// `folder`: what state_folder() said. Errors beside those of all: state: it is empty.
  [[nodiscard]] static Result<LedgerStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty ledger that ends with this object.
  [[nodiscard]] static Result<LedgerStore> unshared();

  /// As open() and unshared() make it.
  explicit LedgerStore(std::unique_ptr<StateFile> file);

  LedgerStore(const LedgerStore&) = delete;
  LedgerStore& operator=(const LedgerStore&) = delete;
  LedgerStore(LedgerStore&&) noexcept;
  LedgerStore& operator=(LedgerStore&&) noexcept;
  ~LedgerStore();

  /// `record` has a record_id, a time and a verdict. One that is there already, whole as it is, is
  /// added by this: a record may be sent twice, where nobody knows whether it arrived. Errors also:
  /// state: another one has its record_id.
  [[nodiscard]] Result<void> add(const LedgerRecord& record);

  /// In the order in which they were added, until `take` gives false.
  [[nodiscard]] Result<void> each(const LedgerQuery& query,
                                  const std::function<bool(const LedgerRecord&)>& take) const;

  /// The path of its file, also while it is not there; empty: it never is.
  [[nodiscard]] const std::string& path() const;

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
