#pragma once
// What only one process of this machine does on an interface at a time.

#include "blactl/base/error.hpp"
#include "blactl/state/lock_file.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace blactl::state {

/// The right to write to servos (`<interface>.write`), or to allocate node IDs
/// (`<interface>.alloc`), for as long as this object lives.
class InterfaceLock {
 public:
  enum class Right : std::uint8_t { write, allocate };

  /// Where nothing can be written nobody is kept away. Errors: busy, naming the process.
  [[nodiscard]] static Result<InterfaceLock>
  acquire(std::string_view interface, Right right,
          const std::string& shared = LockFile::shared_folder);

 private:
  explicit InterfaceLock(std::optional<LockFile> file) : file_(std::move(file)) {}

  std::optional<LockFile> file_;
};

} // namespace blactl::state
