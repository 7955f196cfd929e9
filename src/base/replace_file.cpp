#include "blactl/base/replace_file.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/base/texts.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

namespace blactl {
namespace {

bool write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = write(descriptor, content.data(), content.size());
    if (written < 0 && errno != EINTR) {
      return false;
    }
    content.remove_prefix(static_cast<std::size_t>(written < 0 ? 0 : written));
  }
  return fsync(descriptor) == 0;
}

/// Sets the mode of the file that is replaced, or that a new file would have, because mkstemp()
/// makes the file private.
bool set_rights(int descriptor, const std::string& target) {
  constexpr mode_t rights = 0777;
  struct stat there{};
  if (stat(target.c_str(), &there) == 0) {
    return fchmod(descriptor, there.st_mode & rights) == 0;
  }
  const mode_t mask = umask(0);
  umask(mask);
  return fchmod(descriptor, 0666 & ~mask) == 0;
}

std::unexpected<Error> failure(const std::string& path, int error) {
  return fail(Code::io, say<texts::file_unwritable>(printable(path), system_reason(error)),
              say<texts::file_unwritable_hint>());
}

/// The file behind a symbolic link, which stays a link. Anything but a regular file (a device, a
/// pipe) must not be replaced by one.
Result<std::string> target_of(const std::string& path) {
  struct stat there{};
  if (stat(path.c_str(), &there) != 0) {
    return path;
  }
  if (!S_ISREG(there.st_mode)) {
    return failure(path, S_ISDIR(there.st_mode) ? EISDIR : EINVAL);
  }
  if (access(path.c_str(), W_OK) != 0) { // the folder alone would let it be replaced
    return failure(path, errno);
  }
  const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr),
                                                         &std::free);
  return real ? Result<std::string>(real.get()) : failure(path, errno);
}

/// A new file, open, beside the one that it may replace.
struct Beside {
  std::string target, path;
  int descriptor = -1;
};

Result<Beside> open_beside(const std::string& named) {
  const auto target = target_of(named);
  if (!target) {
    return std::unexpected(target.error());
  }
  Beside made{*target, *target + ".XXXXXX"};
  made.descriptor = mkostemp(made.path.data(), O_CLOEXEC);
  return made.descriptor < 0 ? failure(*target, errno) : Result<Beside>(std::move(made));
}

} // namespace

Result<void> replace_file(const std::string& named, std::string_view content) {
  const auto made = open_beside(named);
  if (!made) {
    return std::unexpected(made.error());
  }
  const bool written =
      set_rights(made->descriptor, made->target) && write_all(made->descriptor, content);
  int error = errno;
  const bool closed = close(made->descriptor) == 0;
  error = written && !closed ? errno : error;
  if (written && closed && std::rename(made->path.c_str(), made->target.c_str()) == 0) {
    return {};
  }
  error = written && closed ? errno : error;
  unlink(made->path.c_str());
  return failure(made->target, error);
}

Result<void> check_replaceable(const std::string& named) {
  const auto made = open_beside(named);
  if (!made) {
    return std::unexpected(made.error());
  }
  close(made->descriptor);
  unlink(made->path.c_str());
  return {};
}

} // namespace blactl
