#include "can/device_holder.hpp"

#include "blactl/base/text.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace blactl::can {
namespace {

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

} // namespace

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

} // namespace blactl::can
