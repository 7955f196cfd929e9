#pragma once
// The name of a station of a production line, which one process of this machine has at a time.

#include "blactl/base/error.hpp"
#include "blactl/state/lock_file.hpp"

#include <optional>
#include <string>
#include <utility>

namespace blactl::state {

/// For as long as it lives, what this station has begun in the ledger of a state folder is this
/// process's own.
class StationLock {
 public:
  /// `folder`: from state_folder(). Without a writable folder for locks nobody is locked out.
  /// Errors: busy.
  [[nodiscard]] static Result<StationLock> acquire(const std::string& folder,
                                                   const std::string& station);

 private:
  explicit StationLock(std::optional<LockFile> file) : file_(std::move(file)) {}

  std::optional<LockFile> file_;
};

} // namespace blactl::state
