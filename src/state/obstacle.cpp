#include "state/obstacle.hpp"

#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

namespace blactl::state {

int obstacle_in(const std::string& folder) {
  constexpr unsigned long room = 64UL * 1024;
  struct statvfs disk{};
  if (access(folder.c_str(), W_OK | X_OK) != 0 || statvfs(folder.c_str(), &disk) != 0) {
    return errno;
  }
  // Some file systems do not know their size.
  const bool is_full = disk.f_blocks != 0 && disk.f_bavail < room / disk.f_frsize;
  return is_full ? ENOSPC : 0;
}

int obstacle_to(const std::string& file) {
  return access(file.c_str(), W_OK) != 0
             ? errno
             : obstacle_in(std::filesystem::path(file).parent_path().string());
}

} // namespace blactl::state
