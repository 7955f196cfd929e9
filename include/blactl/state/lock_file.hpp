#pragma once
// Files that only one process of this machine holds at a time.

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::state {

/// Why a lock file cannot be had.
struct LockRefusal {
  std::string path;
  std::optional<std::int32_t> pid{}; ///< of the process that holds it, if it says so
  int error = 0;                     ///< errno; 0: another process holds it
};

/// A locked file `<interface>.<suffix>` that names this process. It lies in the folder for all
/// users, else in $XDG_RUNTIME_DIR/blactl, else in the state folder; the kernel releases the lock
/// when the process dies. Behind its header lies
/// what the holder before left; nothing, if that was no process of this tool.
class LockFile {
 public:
  /// Where all users of a machine meet.
  static constexpr const char* shared_folder = "/run/lock/blactl";

  /// Where the holder's data begins.
  static constexpr long data_offset = 16;

  /// The folder for lock files; empty: nothing can be written anywhere.
  [[nodiscard]] static std::string folder(const std::string& shared = shared_folder);

  [[nodiscard]] static std::expected<LockFile, LockRefusal>
  take(const std::string& folder, std::string_view interface, std::string_view suffix);

  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  LockFile(LockFile&& other) noexcept;
  LockFile& operator=(LockFile&& other) noexcept;
  ~LockFile();

  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  explicit LockFile(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

} // namespace blactl::state
