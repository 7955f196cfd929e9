#pragma once
// Files that only one process of this machine holds at a time.

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace blactl::state {

/// Where the lock files of an interface lie, and how they begin.
struct LockPlace {
  std::string interface{}; ///< as people name it; empty: no other process can reach it
  /// What tells it from a namesake: "can0" of another network namespace is another interface.
  /// Empty: the name is enough.
  std::string network{};
  std::string folder = "/run/lock/blactl"; ///< where all users meet, if it can be used
};

/// Why a lock file cannot be had.
struct LockRefusal {
  std::string path;
  std::optional<std::int32_t> pid{}; ///< of the process that holds it, if it says so
  int error = 0;                     ///< errno; 0: another process holds it
};

/// A locked file `<interface><network>.<suffix>` that names this process. It lies in the folder for
/// all users, else in $XDG_RUNTIME_DIR/blactl, else in the state folder; the kernel releases the
/// lock when the process dies. Behind its header lies what the holder before left; nothing, if that
/// was no process of this tool.
class LockFile {
 public:
  /// Where the holder's data begins.
  static constexpr long data_offset = 16;

  /// The folder for lock files; empty: nothing can be written anywhere. One that cannot be used
  /// (of another user, no folder, too long a name, read-only) is passed over, whatever names it.
  [[nodiscard]] static std::string folder(const LockPlace& place);

  /// `folder`: what folder() said.
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
