#include "blactl/base/file_hold.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/base/texts.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace blactl {
namespace {

/// Whether the path still names the open file: it may have been replaced before it was held.
bool is_named(int descriptor, const std::string& path) {
  struct stat held{};
  struct stat named{};
  return fstat(descriptor, &held) == 0 && stat(path.c_str(), &named) == 0 &&
         held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

} // namespace

Result<FileHold> FileHold::take(const std::string& path) {
  const auto busy = [&] {
    return fail(Code::busy, say<texts::file_held>(printable(path)), say<texts::file_held_hint>());
  };
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return fail(Code::io, say<texts::file_unreadable>(printable(path), system_reason(errno)),
                say<texts::file_hint>());
  }
  FileHold hold(descriptor);
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return busy();
  }
  return is_named(descriptor, path) ? Result<FileHold>(std::move(hold)) : busy();
}

FileHold::~FileHold() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

} // namespace blactl
