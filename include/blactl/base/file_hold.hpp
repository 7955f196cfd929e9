#pragma once
// A file that two runs of this program must not replace at once.

#include "blactl/base/error.hpp"

#include <string>
#include <utility>

namespace blactl {

/// Keeps other holders from the file that a path names now, and from the one that replaces it, as
/// they look again. The kernel ends it when the process dies.
class FileHold {
 public:
  /// Errors: io; busy: another process holds it. A file system without locks lets everybody in.
  [[nodiscard]] static Result<FileHold> take(const std::string& path);

  FileHold(const FileHold&) = delete;
  FileHold& operator=(const FileHold&) = delete;
  FileHold& operator=(FileHold&&) = delete;

  FileHold(FileHold&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

  ~FileHold();

 private:
  explicit FileHold(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

} // namespace blactl
