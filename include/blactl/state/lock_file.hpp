#pragma once
// Files that only one process of this machine holds at a time.

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace blactl::state {

/// The location and name of an interface's lock files.
struct LockPlace {
  std::string interface{}; ///< its name for people; empty: no other process can reach it
  /// Distinguishes namesakes: "can0" of another network namespace is another interface. Empty: the
  /// name is enough.
  std::string network{};
  std::string folder = "/run/lock/blactl"; ///< common to all users, if usable
};

/// Why a lock file could not be taken.
struct LockRefusal {
  std::string path;
  std::optional<std::int32_t> pid{}; ///< of the process that holds it, if known
  int error = 0;                     ///< errno; 0: another process holds it
};

/// A locked file `<interface><network>.<suffix>` that names this process. It lies in the folder for
/// all users, else in $XDG_RUNTIME_DIR/blactl, else in the state folder; the kernel releases the
/// lock when the process dies. After its header it has the data of its previous holder, or nothing
/// if that was not a process of this tool.
class LockFile {
 public:
  /// The offset of the holder's data.
  static constexpr long data_offset = 16;

  /// The folder for lock files; empty: none is writable. One that is unusable (of another user, not
  /// a folder, name too long, read-only) is skipped, wherever it is named.
  [[nodiscard]] static std::string folder(const LockPlace& place);

  /// `folder`: from folder().
  [[nodiscard]] static std::expected<LockFile, LockRefusal>
  take(const std::string& folder, const LockPlace& place, std::string_view suffix);

  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  LockFile(LockFile&& other) noexcept;
  LockFile& operator=(LockFile&& other) noexcept;
  ~LockFile();

  [[nodiscard]] int descriptor() const { return descriptor_; }

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  LockFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}

  int descriptor_;
  std::string path_;
};

} // namespace blactl::state
