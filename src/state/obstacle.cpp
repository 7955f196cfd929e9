#include "state/obstacle.hpp"

#include <sys/statvfs.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <iterator>

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

bool is_on_network(const std::string& folder) {
  // statfs(2): NFS, SMB, CIFS, SMB2, NCP, AFS (of two kinds), Coda, Ceph, Lustre, GPFS
  constexpr std::uint32_t network[]{0x6969,     0x517B,     0xFF534D42, 0xFE534D42,
                                    0x564C,     0x5346414F, 0x6B414653, 0x73757245,
                                    0x00C36400, 0x0BD00BD0, 0x47504653};
  struct statfs disk{};
  return statfs(folder.c_str(), &disk) == 0 &&
         std::ranges::find(network, static_cast<std::uint32_t>(disk.f_type)) != std::end(network);
}

} // namespace blactl::state
