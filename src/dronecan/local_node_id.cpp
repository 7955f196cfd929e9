#include "blactl/dronecan/local_node_id.hpp"

#include "blactl/dronecan/texts.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
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

std::string state_folder() {
  if (const char* folder = std::getenv("BLACTL_STATE_DIR")) {
    return folder;
  }
  if (const char* home = std::getenv("XDG_STATE_HOME")) {
    return std::string(home) + "/blactl";
  }
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : "") + "/.local/state/blactl";
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
std::string lock_folder() {
  constexpr mode_t shared = 01777;
  constexpr mode_t own = 0700;
  if (usable("/run/lock/blactl", shared)) {
    return "/run/lock/blactl";
  }
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR")) {
    if (const std::string folder = std::string(runtime) + "/blactl"; usable(folder, own)) {
      return folder;
    }
  }
  const std::string folder = state_folder();
  return usable(folder, own) ? folder : std::string();
}

/// Interface names become one path component.
std::string file_name(std::string_view interface, NodeId id) {
  std::string name;
  for (const char c : interface) {
    name += c == '/' || c == '\0' ? '_' : c;
  }
  return name + '.' + std::to_string(id.value());
}

struct Lock {
  int descriptor = -1;
  std::int32_t holder = 0; ///< the process that has it, if descriptor is -1
};

Lock take(const std::string& path) {
  const mode_t before = umask(0);
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  umask(before);
  if (fd < 0) {
    return {};
  }
  if (flock(fd, LOCK_EX | LOCK_NB) == 0) {
    return {fd, 0};
  }
  LockFile file{};
  const bool known = pread(fd, &file, sizeof file, 0) == sizeof file && file.magic == magic;
  close(fd);
  return {-1, known ? file.pid : 0};
}

LockFile* map(int descriptor) {
  if (ftruncate(descriptor, sizeof(LockFile)) != 0) {
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

Result<LocalNodeId> LocalNodeId::acquire(std::string_view interface, std::optional<NodeId> wanted) {
  const std::vector<NodeId> choices =
      wanted ? std::vector{*wanted} : std::vector{NodeId(127), NodeId(126)};
  // Where nothing can be written, nothing is known of other processes: a random start makes a
  // repeated transfer ID unlikely.
  const auto by_chance = [] {
    return static_cast<TransferId>(std::random_device{}() % transfer_id_modulus);
  };
  const std::string folder = lock_folder();
  if (folder.empty()) {
    return LocalNodeId(std::make_unique<State>(choices.front(), -1, nullptr, by_chance()));
  }
  std::string holders;
  for (const NodeId id : choices) {
    const Lock lock = take(folder + '/' + file_name(interface, id));
    if (lock.descriptor >= 0) {
      LockFile* file = map(lock.descriptor);
      const TransferId first = file != nullptr ? TransferId{0} : by_chance();
      return LocalNodeId(std::make_unique<State>(id, lock.descriptor, file, first));
    }
    holders += holders.empty() ? "" : ", ";
    holders += say<texts::node_id_held_by>(id.value(), lock.holder);
  }
  return fail(Code::no_local_node_id, say<texts::no_local_node_id>(interface, holders),
              say<texts::no_local_node_id_hint>());
}

LocalNodeId LocalNodeId::unshared(std::optional<NodeId> wanted) {
  return LocalNodeId(
      std::make_unique<State>(wanted.value_or(NodeId(127)), -1, nullptr, TransferId{0}));
}

} // namespace blactl::dronecan
