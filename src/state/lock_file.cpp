#include "blactl/state/lock_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

namespace blactl::state {
namespace {

/// Only processes of this tool write it; whoever can has this machine's lock folder anyway.
struct FileHeader {
  std::array<char, 8> magic;
  std::int32_t pid;
  std::uint32_t reserved;
};

static_assert(sizeof(FileHeader) == LockFile::data_offset);

constexpr std::array<char, 8> magic{'b', 'l', 'a', 'c', 't', 'l', '\1', '\0'};

bool read_header(int descriptor, FileHeader& header) {
  return pread(descriptor, &header, sizeof header, 0) == sizeof header && header.magic == magic;
}

/// Empty is as good as unset (XDG base directory specification).
std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string state_folder() {
  if (std::string folder = variable("BLACTL_STATE_DIR"); !folder.empty()) {
    return folder;
  }
  if (const std::string home = variable("XDG_STATE_HOME"); !home.empty()) {
    return home + "/blactl";
  }
  return variable("HOME") + "/.local/state/blactl";
}

/// A folder that exists now, is no symbolic link and can be written; 01777 where all users share.
bool usable(const std::string& folder, mode_t mode) {
  if (mkdir(folder.c_str(), mode) == 0) {
    chmod(folder.c_str(), mode); // past the umask
  }
  struct stat info{};
  return lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) &&
         access(folder.c_str(), W_OK | X_OK) == 0;
}

/// Interface names become one path component.
std::string file_name(std::string_view interface, std::string_view suffix) {
  std::string name;
  for (const char c : interface) {
    name += c == '/' || c == '\0' ? '_' : c;
  }
  return name.append(1, '.').append(suffix);
}

/// Opens a lock file, made if it is not there. One that another user made must not be opened with
/// O_CREAT: in a folder for all the kernel would refuse it (fs.protected_regular).
int open_file(const std::string& path) {
  constexpr int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  int fd = open(path.c_str(), flags);
  if (fd < 0 && errno == ENOENT) {
    const mode_t before = umask(0);
    fd = open(path.c_str(), flags | O_CREAT | O_EXCL, 0666);
    umask(before);
    if (fd < 0 && errno == EEXIST) { // another process was faster
      fd = open(path.c_str(), flags);
    }
  }
  return fd;
}

} // namespace

/// The same for all users where the system allows it.
std::string LockFile::folder(const std::string& shared) {
  constexpr mode_t of_all = 01777;
  constexpr mode_t own = 0700;
  if (usable(shared, of_all)) {
    return shared;
  }
  if (const std::string runtime = variable("XDG_RUNTIME_DIR"); !runtime.empty()) {
    if (const std::string folder = runtime + "/blactl"; usable(folder, own)) {
      return folder;
    }
  }
  const std::filesystem::path folder = state_folder();
  std::error_code ignored;
  std::filesystem::create_directories(folder.parent_path(), ignored);
  return usable(folder.string(), own) ? folder.string() : std::string();
}

std::expected<LockFile, LockRefusal>
LockFile::take(const std::string& folder, std::string_view interface, std::string_view suffix) {
  const std::string path = folder + '/' + file_name(interface, suffix);
  const int fd = open_file(path);
  if (fd < 0) {
    return std::unexpected(LockRefusal{.path = path, .error = errno});
  }
  FileHeader header{};
  const bool had_data = read_header(fd, header);
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
    close(fd);
    return std::unexpected(
        LockRefusal{.path = path, .pid = had_data ? std::optional(header.pid) : std::nullopt});
  }
  if (!had_data) {
    (void)ftruncate(fd, 0); // what lies in it is nobody's
  }
  // A full disk keeps the name of the holder out of it, and hurts nobody else. Then no name is
  // better than that of the holder before.
  header = {magic, getpid(), 0};
  if (pwrite(fd, &header, sizeof header, 0) != sizeof header) {
    (void)ftruncate(fd, 0);
  }
  return LockFile(fd);
}

LockFile::LockFile(LockFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

LockFile& LockFile::operator=(LockFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

LockFile::~LockFile() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

} // namespace blactl::state
