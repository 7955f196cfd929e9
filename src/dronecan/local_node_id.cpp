#include "blactl/dronecan/local_node_id.hpp"

#include "blactl/dronecan/texts.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <expected>
#include <filesystem>
#include <random>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace blactl::dronecan {
namespace {

/// What a lock file holds. Only processes of this tool write it; whoever can has this machine's
/// lock folder anyway, and the worst a wrong counter does is one repeated request.
struct LockFile {
  std::array<char, 8> magic;
  std::int32_t pid;
  std::uint32_t reserved;
  std::array<TransferIds::Slot, TransferIds::slots> slots;
};

constexpr std::array<char, 8> magic{'b', 'l', 'a', 'c', 't', 'l', '\1', '\0'};

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

/// The folder for lock files, the same for all users where the system allows it. Empty: none.
std::string lock_folder(const std::string& shared) {
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

/// Interface names become one path component.
std::string file_name(std::string_view interface, NodeId id) {
  std::string name;
  for (const char c : interface) {
    name += c == '/' || c == '\0' ? '_' : c;
  }
  return name + '.' + std::to_string(id.value());
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

/// The descriptor of the locked file; else why the ID cannot be had, for a person.
std::expected<int, std::string> take(const std::string& path, NodeId id) {
  const int fd = open_file(path);
  if (fd < 0) {
    return std::unexpected(
        say<texts::node_id_lock_failed>(id.value(), printable(path), std::strerror(errno)));
  }
  if (flock(fd, LOCK_EX | LOCK_NB) == 0) {
    return fd;
  }
  LockFile file{};
  const bool known = pread(fd, &file, sizeof file, 0) == sizeof file && file.magic == magic;
  close(fd);
  return std::unexpected(known ? say<texts::node_id_held_by>(id.value(), file.pid)
                               : say<texts::node_id_held>(id.value()));
}

/// Null: the disk is full, or the file is none that can be mapped.
LockFile* map(int descriptor) {
  // Not ftruncate(): a page of a hole that the disk has no room for would kill the process.
  if (posix_fallocate(descriptor, 0, sizeof(LockFile)) != 0) {
    return nullptr;
  }
  void* memory = mmap(nullptr, sizeof(LockFile), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) { // NOLINT: the macro casts
    return nullptr;
  }
  auto* file = static_cast<LockFile*>(memory);
  if (file->magic != magic) {
    std::memset(memory, 0, sizeof(LockFile));
    file->magic = magic;
  }
  file->pid = getpid();
  return file;
}

} // namespace

struct LocalNodeId::State {
  State(NodeId node_id, int fd, LockFile* mapped, TransferId first)
      : id(node_id), descriptor(fd), file(mapped),
        transfer_ids(mapped != nullptr ? mapped->slots : own, first) {}

  ~State() {
    if (file != nullptr) {
      munmap(file, sizeof(LockFile));
    }
    if (descriptor >= 0) {
      close(descriptor);
    }
  }

  State(const State&) = delete;
  State& operator=(const State&) = delete;

  NodeId id;
  int descriptor;
  LockFile* file;
  std::array<TransferIds::Slot, TransferIds::slots> own{};
  TransferIds transfer_ids;
};

LocalNodeId::LocalNodeId(std::unique_ptr<State> state) : state_(std::move(state)) {}

LocalNodeId::LocalNodeId(LocalNodeId&&) noexcept = default;
LocalNodeId& LocalNodeId::operator=(LocalNodeId&&) noexcept = default;
LocalNodeId::~LocalNodeId() = default;

NodeId LocalNodeId::id() const {
  return state_->id;
}

TransferIds& LocalNodeId::transfer_ids() {
  return state_->transfer_ids;
}

Result<LocalNodeId> LocalNodeId::acquire(std::string_view interface, std::optional<NodeId> wanted,
                                         const std::string& shared) {
  const std::vector<NodeId> choices =
      wanted ? std::vector{*wanted} : std::vector{NodeId(127), NodeId(126)};
  // Where nothing can be written, nothing is known of other processes: a random start makes a
  // repeated transfer ID unlikely.
  const auto by_chance = [] {
    return static_cast<TransferId>(std::random_device{}() % transfer_id_modulus);
  };
  const std::string folder = lock_folder(shared);
  if (folder.empty()) {
    return LocalNodeId(std::make_unique<State>(choices.front(), -1, nullptr, by_chance()));
  }
  std::string holders;
  for (const NodeId id : choices) {
    const auto locked = take(folder + '/' + file_name(interface, id), id);
    if (locked) {
      LockFile* file = map(*locked);
      const TransferId first = file != nullptr ? TransferId{0} : by_chance();
      return LocalNodeId(std::make_unique<State>(id, *locked, file, first));
    }
    holders += holders.empty() ? "" : ", ";
    holders += locked.error();
  }
  return fail(Code::no_local_node_id, say<texts::no_local_node_id>(interface, holders),
              say<texts::no_local_node_id_hint>());
}

LocalNodeId LocalNodeId::unshared(std::optional<NodeId> wanted) {
  return LocalNodeId(
      std::make_unique<State>(wanted.value_or(NodeId(127)), -1, nullptr, TransferId{0}));
}

} // namespace blactl::dronecan
