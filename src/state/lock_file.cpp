#include "blactl/state/lock_file.hpp"

#include "blactl/state/state_folder.hpp"

#include "state/environment.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace blactl::state {
namespace {

/// Written by processes of this tool only; anyone else able to could also replace the lock folder.
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

/// Creates the folder if missing; returns whether it is a writable folder, not a symbolic link.
bool usable(const std::string& folder, mode_t mode) {
  if (mkdir(folder.c_str(), mode) == 0) {
    chmod(folder.c_str(), mode); // despite the umask
  }
  struct stat info{};
  return lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) &&
         access(folder.c_str(), W_OK | X_OK) == 0;
}

/// FNV-1a: the same in every build.
std::uint64_t digest(std::string_view text) {
  std::uint64_t value = 0xCBF29CE484222325;
  for (const char c : text) {
    value = (value ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  }
  return value;
}

/// Interface names become one path component. One that is too long keeps its end, where paths
/// differ, and a hash of the whole name.
std::string file_name(const LockPlace& place, std::string_view suffix) {
  constexpr std::size_t longest = 200; // NAME_MAX less the number, the network and the suffix
  std::string name = place.interface;
  for (char& c : name) {
    c = c == '/' || c == '\0' ? '_' : c;
  }
  if (name.size() > longest) {
    name = std::to_string(digest(place.interface)) + name.substr(name.size() - longest);
  }
  return name.append(place.network).append(1, '.').append(suffix);
}

/// Opens or creates a lock file. Another user's file must not be opened with O_CREAT: in a shared
/// folder the kernel would refuse it (fs.protected_regular).
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

/// Returns the same folder for all users where the system allows it.
std::string LockFile::folder(const LockPlace& place) {
  constexpr mode_t of_all = 01777;
  constexpr mode_t own = 0700;
  if (usable(place.folder, of_all)) {
    return place.folder;
  }
  if (const std::string runtime = folder_variable("XDG_RUNTIME_DIR"); !runtime.empty()) {
    if (const std::string folder = runtime + "/blactl"; usable(folder, own)) {
      return folder;
    }
  }
  const std::filesystem::path folder = state_folder();
  if (folder.empty()) {
    return {};
  }
  std::error_code ignored;
  std::filesystem::create_directories(folder.parent_path(), ignored);
  return usable(folder.string(), own) ? folder.string() : std::string();
}

std::expected<LockFile, LockRefusal>
LockFile::take(const std::string& folder, const LockPlace& place, std::string_view suffix) {
  const std::string path = folder + '/' + file_name(place, suffix);
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
    (void)ftruncate(fd, 0); // its content is stale
  }
  // On a full disk the holder's PID may be missing, which is harmless, and better than that of the
  // previous holder.
  header = {magic, getpid(), 0};
  if (pwrite(fd, &header, sizeof header, 0) != sizeof header) {
    (void)ftruncate(fd, 0);
  }
  return LockFile(fd, path);
}

LockFile::LockFile(LockFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

LockFile& LockFile::operator=(LockFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(path_, other.path_);
  return *this;
}

LockFile::~LockFile() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

} // namespace blactl::state
