#pragma once
// The disk under SQLite, of which the computer's power is cut: what was not synced by then is there
// afterwards, or not, or in part, in whatever order it was written.

#include "chance.hpp"
#include "disturbance.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

struct sqlite3_vfs;

namespace blactl::campaign {

/// A file as it may be after the cut.
struct DiskFile {
  using Bytes = std::vector<std::uint8_t>;

  /// What came since the last sync: bytes at a place, or without any a new end.
  struct Later {
    std::size_t at = 0;
    Bytes bytes;
  };

  bool is_certain = false; ///< it has been synced, and so has its name
  bool is_removed = false; ///< but the folder was not synced since
  Bytes synced;
  std::vector<Later> later;
};

/// While it lives SQLite writes through it. `cut` counts each write, sync and removal, and strikes
/// one of them: that and all later ones fail, and no frame leaves the computer any more.
class Disk {
 public:
  explicit Disk(Disturbance& cut);
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// Makes of the files what the cut may have left of them; all are closed.
  void come_back(Chance chance);

  /// By path.
  [[nodiscard]] std::map<std::string, DiskFile>& files() { return files_; }

  /// Counts, and tells whether there is power.
  [[nodiscard]] bool has_power() { return !cut_.has_struck() && !cut_.strikes(); }

 private:
  Disturbance& cut_;
  std::map<std::string, DiskFile> files_;
  sqlite3_vfs* usual_;
  std::unique_ptr<sqlite3_vfs> own_;
};

} // namespace blactl::campaign
