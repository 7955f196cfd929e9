#include "blactl/can/simbus.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/can/simbus_texts.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

namespace blactl::can {

using sim_wire::Kind;
using sim_wire::Message;

namespace {

constexpr std::size_t queue_capacity = 10;
constexpr int answer_timeout = 2000; // ms

/// `su` may keep another user's folder in the environment.
bool is_usable(const char* folder) {
  struct stat status{};
  return stat(folder, &status) == 0 && S_ISDIR(status.st_mode) && access(folder, W_OK | X_OK) == 0;
}

std::unexpected<Error> absent(const std::filesystem::path& path, int error) {
  return fail(Code::interface,
              say<texts::simbus_absent>(printable(path.string()), system_reason(error)),
              say<texts::simbus_absent_hint>());
}

struct Attempt {
  int socket = -1;
  int error = 0; ///< errno, if there is no socket

  /// Whether there is no socket, or its process is gone.
  [[nodiscard]] bool met_nobody() const {
    return error == ENOENT || error == ENOTDIR || error == ECONNREFUSED;
  }
};

/// Errors: those that starting a simulator would not mend.
Result<Attempt> connect_to(const std::filesystem::path& path) {
  sockaddr_un address{};
  const std::string name = path.string();
  if (name.size() >= sizeof address.sun_path) {
    return fail(Code::interface,
                say<texts::simbus_path_too_long>(printable(name), sizeof address.sun_path - 1));
  }
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path, name.size());
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) {
    return Attempt{.error = errno};
  }
  const void* raw = &address;
  if (connect(socket, static_cast<const sockaddr*>(raw), sizeof address) != 0) {
    const int error = errno;
    close(socket);
    return Attempt{.error = error};
  }
  return Attempt{.socket = socket};
}

} // namespace

std::filesystem::path default_socket_path() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] == '/') {
    const auto path = std::filesystem::path(runtime) / "blactl" / "sim";
    if (path.native().size() < sizeof(sockaddr_un::sun_path) && is_usable(runtime)) {
      return path;
    }
  }
  return std::filesystem::path("/tmp") / ("blactl-" + std::to_string(geteuid())) / "sim";
}

bool is_own_folder(const std::filesystem::path& folder) {
  struct stat status{};
  return lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

Result<std::unique_ptr<SimBus>> SimBus::open(const std::filesystem::path& socket,
                                             std::string name) {
  int nobody = 0;
  auto bus = open(socket, std::move(name), nobody);
  return nobody != 0 ? absent(socket, nobody) : std::move(bus);
}

bool SimBus::is_served(const std::filesystem::path& socket) {
  const auto attempt = connect_to(socket);
  if (attempt && attempt->socket >= 0) {
    close(attempt->socket);
    return true;
  }
  return false;
}

Result<std::unique_ptr<SimBus>> SimBus::open_if_served(const std::filesystem::path& socket,
                                                       std::string name) {
  int nobody = 0;
  return open(socket, std::move(name), nobody);
}

/// Returns null, with errno in `nobody`, if nobody listens.
Result<std::unique_ptr<SimBus>> SimBus::open(const std::filesystem::path& socket, std::string name,
                                             int& nobody) {
  const auto folder = socket.parent_path();
  std::error_code unseen; // a path that cannot be examined cannot be connected to either
  if (socket == default_socket_path() && std::filesystem::exists(folder, unseen) &&
      !is_own_folder(folder)) {
    return fail(Code::interface, say<texts::simbus_foreign_folder>(printable(folder.string())),
                say<texts::simbus_foreign_folder_hint>());
  }
  const auto attempt = connect_to(socket);
  if (!attempt) {
    return std::unexpected(attempt.error());
  }
  if (attempt->socket < 0) {
    if (!attempt->met_nobody()) {
      return absent(socket, attempt->error);
    }
    nobody = attempt->error;
    return nullptr;
  }
  std::unique_ptr<SimBus> bus(new SimBus(attempt->socket, socket, std::move(name)));
  if (const auto greeted = bus->greet(); !greeted) {
    return std::unexpected(greeted.error());
  }
  return bus;
}

SimBus::~SimBus() {
  close(socket_);
}

Result<void> SimBus::greet() {
  if (auto said = post({.kind = Kind::hello, .value = sim_wire::version}); !said) {
    return said;
  }
  pollfd readable{socket_, POLLIN, 0};
  Message welcome;
  if (poll(&readable, 1, answer_timeout) <= 0 ||
      recv(socket_, &welcome, sizeof welcome, MSG_TRUNC) != sizeof welcome ||
      welcome.kind != Kind::welcome) {
    return fail(Code::interface, say<texts::simbus_silent>(printable(path_.string())),
                say<texts::simbus_absent_hint>());
  }
  if (welcome.value != sim_wire::version) {
    return fail(Code::interface, say<texts::simbus_version>(printable(path_.string())),
                say<texts::simbus_version_hint>());
  }
  ++messages_read_;
  virtual_clock_ = (welcome.flags & sim_wire::virtual_clock) != 0;
  now_ = Time(Duration(welcome.at));
  wall_epoch_ = WallTime(Duration(static_cast<Duration::rep>(welcome.count)));
  return {};
}

Error SimBus::gone() const {
  return {Code::interface, say<texts::simbus_gone>(printable(path_.string())),
          say<texts::simbus_absent_hint>(), std::nullopt};
}

/// The simulator reads its input at once, so a full socket is soon empty again.
Result<void> SimBus::post(const Message& message) {
  const auto sent = [&] {
    return ::send(socket_, &message, sizeof message, MSG_NOSIGNAL) == sizeof message;
  };
  if (sent()) {
    return {};
  }
  pollfd writable{socket_, POLLOUT, 0};
  if (poll(&writable, 1, answer_timeout) > 0 && sent()) {
    return {};
  }
  return std::unexpected(gone());
}

Result<bool> SimBus::send(const Frame& frame) {
  if (unechoed_ >= queue_capacity) {
    return false;
  }
  if (const auto posted = post(sim_wire::with_frame(Kind::send, frame)); !posted) {
    return std::unexpected(posted.error());
  }
  ++unechoed_;
  return true;
}

std::optional<BusEvent> SimBus::receive() {
  while (!gone_) {
    Message message;
    const auto size = recv(socket_, &message, sizeof message, MSG_TRUNC);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
      return std::nullopt;
    }
    if (size != sizeof message) {
      gone_ = true;
      return Gone{gone()};
    }
    ++messages_read_;
    waiting_.reset();
    if (auto happened = event(message)) {
      return happened;
    }
  }
  return std::nullopt;
}

std::optional<BusEvent> SimBus::event(const Message& message) {
  const Time at(Duration(message.at));
  if (virtual_clock_ && message.kind != Kind::overflow) {
    now_ = std::max(now_, at);
  }
  switch (message.kind) {
  case Kind::received: return Received{sim_wire::frame_of(message), at, wall_at(at)};
  case Kind::sent:
    unechoed_ -= unechoed_ > 0 ? 1 : 0;
    return Sent{sim_wire::frame_of(message), at, wall_at(at)};
  case Kind::fault: unechoed_ = 0; return BusFault{static_cast<FaultKind>(message.value), at};
  case Kind::overflow:
    unechoed_ = 0; // their echoes may have been lost
    return Overflow{message.count};
  default: return std::nullopt;
  }
}

std::string SimBus::bus_off_hint() const {
  return say<texts::simbus_off_hint>();
}

Result<void> SimBus::filter(std::span<const Filter> filters) {
  if (auto posted = post({.kind = Kind::filter_none}); !posted) {
    return posted;
  }
  for (const Filter& filter : filters) {
    if (auto posted = post({.kind = Kind::filter_add, .value = filter.mask, .id = filter.id});
        !posted) {
      return posted;
    }
  }
  return {};
}

Time SimBus::now() const {
  return virtual_clock_ ? now_ : Bus::now();
}

WallTime SimBus::wall() const {
  return virtual_clock_ ? wall_epoch_ + now_.time_since_epoch() : Bus::wall();
}

/// On the virtual clock only a message of the simulator ends the wait.
Time SimBus::idle_until(Time deadline) {
  if (!virtual_clock_ || gone_) {
    return deadline;
  }
  const Message wait{
      .kind = Kind::wait, .at = deadline.time_since_epoch().count(), .count = messages_read_};
  // A failure ends the connection, which receive() reports.
  if ((!waiting_ || waiting_->at != wait.at) && post(wait)) {
    waiting_ = wait;
  }
  return never;
}

} // namespace blactl::can
