#include "sim/bus/listening_socket.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/can/simbus.hpp"
#include "blactl/can/simbus_texts.hpp"

#include "sim/scenario/texts.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <string>
#include <tuple>

namespace blactl::sim {
namespace {

/// The lock file holds the PID of its owner, for the next process that wants the place. A full disk
/// prevents that.
void sign(int lock) {
  const std::string pid = std::to_string(getpid()) + '\n';
  std::ignore = ftruncate(lock, 0);
  std::ignore = pwrite(lock, pid.data(), pid.size(), 0);
}

/// The PID written by sign(); 0: nothing plausible.
pid_t signature(int lock) {
  std::array<char, 16> text{};
  const auto size = pread(lock, text.data(), text.size(), 0);
  pid_t pid = 0;
  if (size > 0) {
    std::from_chars(text.data(), text.data() + size, pid);
  }
  return std::max(pid, 0);
}

} // namespace

Result<std::unique_ptr<ListeningSocket>> ListeningSocket::open(const std::filesystem::path& path) {
  std::unique_ptr<ListeningSocket> socket(new ListeningSocket(path));
  for (const auto step :
       {&ListeningSocket::prepare_folder, &ListeningSocket::lock, &ListeningSocket::listen}) {
    if (const auto done = (socket.get()->*step)(); !done) {
      return std::unexpected(done.error());
    }
  }
  return socket;
}

ListeningSocket::~ListeningSocket() {
  if (socket_ >= 0) {
    close(socket_);
  }
  if (bound_) {
    unlink(path_.c_str());
  }
  if (lock_ >= 0) {
    close(lock_); // last: until here nobody else may take the place
  }
}

std::unexpected<Error> ListeningSocket::failure(int error) const {
  return fail(Code::interface,
              say<texts::sim_cannot_serve>(printable(path_.string()), system_reason(error)));
}

/// The default folder may lie in /tmp, where anybody could have made it first.
Result<void> ListeningSocket::prepare_folder() {
  const auto folder = path_.parent_path();
  if (folder.empty()) {
    return {};
  }
  if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
    return fail(Code::interface,
                say<texts::sim_folder>(printable(folder.string()), system_reason(errno)),
                say<texts::sim_folder_hint>());
  }
  if (path_ == can::default_socket_path() && !can::is_own_folder(folder)) {
    return fail(
        Code::interface,
        say<texts::sim_folder>(printable(folder.string()), say<texts::sim_folder_foreign>()),
        say<texts::sim_folder_hint>());
  }
  return {};
}

Result<void> ListeningSocket::lock() {
  const std::string file = path_.string() + ".lock";
  lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  if (lock_ < 0) {
    return failure(errno);
  }
  if (flock(lock_, LOCK_EX | LOCK_NB) == 0) {
    sign(lock_);
    return {};
  }
  if (errno != EWOULDBLOCK) {
    return failure(errno);
  }
  const std::string name = printable(path_.string());
  const pid_t holder = signature(lock_);
  return fail(Code::busy,
              holder > 0 ? say<texts::sim_running_as>(name, holder) : say<texts::sim_running>(name),
              say<texts::sim_running_hint>());
}

Result<void> ListeningSocket::listen() {
  sockaddr_un address{};
  const std::string name = path_.string();
  if (name.size() >= sizeof address.sun_path) {
    return fail(Code::interface,
                say<texts::simbus_path_too_long>(printable(name), sizeof address.sun_path - 1));
  }
  struct stat status{};
  if (lstat(name.c_str(), &status) == 0) {
    if (!S_ISSOCK(status.st_mode)) {
      return fail(Code::interface, say<texts::sim_not_a_socket>(printable(name)));
    }
    unlink(name.c_str()); // its listener held the lock, and is dead
  }
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path, name.size());
  socket_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const void* raw = &address;
  // The mode of the socket before bind() becomes that of the file: it is not open to others even
  // for a moment.
  bound_ = socket_ >= 0 && fchmod(socket_, S_IRUSR | S_IWUSR) == 0 &&
           bind(socket_, static_cast<const sockaddr*>(raw), sizeof address) == 0;
  if (!bound_ || ::listen(socket_, SOMAXCONN) != 0) {
    return failure(errno);
  }
  return {};
}

} // namespace blactl::sim
