#pragma once
// Exclusive rights of one process of this machine on an interface.

#include "blactl/base/error.hpp"
#include "blactl/state/lock_file.hpp"

#include <optional>
#include <string>
#include <utility>

namespace blactl::state {

/// The right to write to servos (lock file `….write`), or to allocate node IDs (`….alloc`), for as
/// long as this object lives.
class InterfaceLock {
 public:
  enum class Right : std::uint8_t { write, allocate };

  /// Without a writable folder nobody is locked out. Errors: busy, naming the process.
  [[nodiscard]] static Result<InterfaceLock> acquire(const LockPlace& place, Right right);

  /// The path of the lock file; empty: there is none.
  [[nodiscard]] std::string file() const { return file_ ? file_->path() : std::string(); }

 private:
  explicit InterfaceLock(std::optional<LockFile> file) : file_(std::move(file)) {}

  std::optional<LockFile> file_;
};

} // namespace blactl::state
