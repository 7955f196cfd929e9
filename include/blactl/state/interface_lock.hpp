#pragma once
// What only one process of this machine does on an interface at a time.

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

  /// Where nothing can be written nobody is kept away. Errors: busy, naming the process.
  [[nodiscard]] static Result<InterfaceLock> acquire(const LockPlace& place, Right right);

  /// Its path; empty: there is none.
  [[nodiscard]] std::string file() const { return file_ ? file_->path() : std::string(); }

 private:
  explicit InterfaceLock(std::optional<LockFile> file) : file_(std::move(file)) {}

  std::optional<LockFile> file_;
};

} // namespace blactl::state
