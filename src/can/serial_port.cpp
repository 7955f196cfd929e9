#include "blactl/can/serial_port.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/can/serial_adapters.hpp"

#include "can/slcan_texts.hpp"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

namespace blactl::can {
namespace {

struct Rate {
  unsigned baud;
  speed_t code;
};

constexpr std::array<Rate, 21> rates{{
    {1200, B1200},       {2400, B2400},       {4800, B4800},       {9600, B9600},
    {19200, B19200},     {38400, B38400},     {57600, B57600},     {115200, B115200},
    {230400, B230400},   {460800, B460800},   {500000, B500000},   {576000, B576000},
    {921600, B921600},   {1000000, B1000000}, {1152000, B1152000}, {1500000, B1500000},
    {2000000, B2000000}, {2500000, B2500000}, {3000000, B3000000}, {3500000, B3500000},
    {4000000, B4000000},
}};

namespace fs = std::filesystem;

/// Calls `visit` with each entry until it returns true; false for a folder that cannot be read.
template <class Visit> bool any_entry(const fs::path& folder, Visit visit) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (visit(it->path())) {
      return true;
    }
  }
  return false;
}

std::optional<pid_t> process_id(const std::string& text) {
  pid_t pid = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, pid);
  return error == std::errc() && stop == end ? std::optional(pid) : std::nullopt;
}

bool has_open(const fs::path& process, dev_t device) {
  return any_entry(process / "fd", [device](const fs::path& link) {
    struct stat status{};
    return stat(link.c_str(), &status) == 0 && S_ISCHR(status.st_mode) && status.st_rdev == device;
  });
}

struct DeviceHolder {
  pid_t pid;
  std::string name; ///< fit for a terminal
};

/// Another process that has the character device `device` open, as far as this user may see it
/// (/proc/PID/fd).
std::optional<DeviceHolder> device_holder(dev_t device) {
  std::optional<DeviceHolder> holder;
  any_entry("/proc", [&](const fs::path& process) {
    const auto pid = process_id(process.filename().string());
    if (!pid || *pid == getpid() || !has_open(process, device)) {
      return false;
    }
    std::string name;
    std::ifstream comm(process / "comm");
    std::getline(comm, name);
    holder = {*pid, printable(name)};
    return true;
  });
  return holder;
}

/// A hint naming the ports that could be meant instead.
std::string likely() {
  std::string adapters = describe(serial_adapters());
  return adapters.empty() ? say<texts::no_serial_adapter_here>() : adapters;
}

std::unexpected<Error> absent(const std::filesystem::path& device) {
  return fail(Code::interface, say<texts::no_such_port>(printable(device.string())), likely());
}

/// The name of a group, or its number if it has none.
std::string group_name(gid_t id) {
  const group* entry = getgrgid(id);
  return entry != nullptr ? printable(entry->gr_name) : std::to_string(id);
}

std::string own_user_name() {
  const passwd* entry = getpwuid(geteuid());
  return entry != nullptr ? printable(entry->pw_name) : std::to_string(geteuid());
}

std::unexpected<Error> forbidden(const std::filesystem::path& device) {
  const std::string name = printable(device.string());
  struct stat status{};
  constexpr mode_t for_group = S_IRGRP | S_IWGRP;
  if (stat(device.c_str(), &status) != 0 || (status.st_mode & for_group) != for_group) {
    return fail(Code::permission, say<texts::port_forbidden>(name),
                say<texts::port_forbidden_hint>(name));
  }
  const std::string group = group_name(status.st_gid);
  return fail(Code::permission, say<texts::port_of_group>(name, group),
              say<texts::port_of_group_hint>(group, own_user_name()));
}

std::unexpected<Error> busy(const std::filesystem::path& device) {
  const std::string name = printable(device.string());
  struct stat status{};
  const auto holder =
      stat(device.c_str(), &status) == 0 ? device_holder(status.st_rdev) : std::nullopt;
  if (!holder) {
    return fail(Code::interface, say<texts::port_busy>(name), say<texts::port_busy_hint>(name));
  }
  return fail(Code::interface, say<texts::port_busy_by>(name, holder->name, holder->pid),
              say<texts::port_busy_by_hint>(holder->pid));
}

std::unexpected<Error> cannot_open(const std::filesystem::path& device, int error) {
  switch (error) {
  case ENOENT:
  case ENOTDIR:
  case ENXIO:
  case ENODEV: return absent(device);
  case EACCES:
  case EPERM: return forbidden(device);
  case EBUSY: return busy(device);
  default:
    return fail(Code::interface,
                say<texts::port_failed>(printable(device.string()), system_reason(error)));
  }
}

std::unexpected<Error> no_serial_port(const std::filesystem::path& device) {
  return fail(Code::interface, say<texts::not_a_serial_port>(printable(device.string())), likely());
}

} // namespace

bool is_baud_rate(unsigned baud) {
  return std::ranges::find(rates, baud, &Rate::baud) != rates.end();
}

Result<std::unique_ptr<SerialPort>> SerialPort::open(const std::filesystem::path& device,
                                                     unsigned baud) {
  // Without O_NONBLOCK opening a port waits for a carrier.
  const int descriptor = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    return errno == EISDIR ? no_serial_port(device) : cannot_open(device, errno);
  }
  std::unique_ptr<SerialPort> port(new SerialPort(device, descriptor));
  if (isatty(descriptor) == 0) {
    return no_serial_port(device);
  }
  if (auto claimed = port->claim(); !claimed) {
    return std::unexpected(std::move(claimed.error()));
  }
  if (auto configured = port->configure(baud); !configured) {
    return std::unexpected(std::move(configured.error()));
  }
  return port;
}

SerialPort::~SerialPort() {
  if (exclusive_) { // else it would last while anybody has the port open
    std::ignore = ioctl(descriptor_, TIOCNXCL);
  }
  close(descriptor_);
}

/// Keeps others from reading our input: modem managers, terminals, a second blactl.
Result<void> SerialPort::claim() {
  // TIOCEXCL does not keep root out; the lock does.
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    return errno == EWOULDBLOCK ? busy(device_) : cannot_open(device_, errno);
  }
  // slcand may have made a network interface of it.
  int discipline = N_TTY;
  if (ioctl(descriptor_, TIOCGETD, &discipline) == 0 && discipline != N_TTY) {
    return busy(device_);
  }
  exclusive_ = ioctl(descriptor_, TIOCEXCL) == 0;
  return {};
}

Result<void> SerialPort::configure(unsigned baud) {
  termios mode{};
  if (tcgetattr(descriptor_, &mode) != 0) {
    return cannot_open(device_, errno);
  }
  cfmakeraw(&mode);
  mode.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB | PARENB);
  mode.c_cflag |= static_cast<tcflag_t>(CLOCAL | CREAD | CS8);
  mode.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY);
  // With a minimum of 1, a read of 0 bytes means that the device is gone, not that it is silent.
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  const auto rate = std::ranges::find(rates, baud, &Rate::baud);
  if (rate == rates.end() || cfsetspeed(&mode, rate->code) != 0 ||
      tcsetattr(descriptor_, TCSANOW, &mode) != 0 || tcflush(descriptor_, TCIOFLUSH) != 0) {
    return fail(Code::interface, say<texts::port_rate_failed>(printable(device_.string()), baud,
                                                              system_reason(errno)));
  }
  return {};
}

std::unexpected<Error> SerialPort::gone(int error) const {
  const std::string name = printable(device_.string());
  if (error == 0 || error == EIO || error == ENXIO || error == ENODEV) {
    return fail(Code::interface, say<texts::adapter_gone>(name), say<texts::adapter_gone_hint>());
  }
  return fail(Code::interface, say<texts::port_failed>(name, system_reason(error)),
              say<texts::adapter_gone_hint>());
}

Result<std::size_t> SerialPort::read(std::span<char> bytes) {
  const auto size = ::read(descriptor_, bytes.data(), bytes.size());
  if (size > 0) {
    return static_cast<std::size_t>(size);
  }
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
    return 0;
  }
  return gone(size == 0 ? 0 : errno);
}

Result<std::size_t> SerialPort::write(std::string_view bytes) {
  const auto size = ::write(descriptor_, bytes.data(), bytes.size());
  if (size >= 0) {
    return static_cast<std::size_t>(size);
  }
  if (errno == EAGAIN || errno == EINTR) {
    return 0;
  }
  return gone(errno);
}

} // namespace blactl::can
