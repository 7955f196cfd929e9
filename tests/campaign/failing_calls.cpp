// System calls that fail on demand: these functions stand before those of the C library, for SQLite
// as well. The sanitizers do the same, so there they are left out.

#include "disturbance.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>

namespace blactl::campaign {
namespace {

Disturbance* active = nullptr; // of the only thread

} // namespace

void fail_calls(Disturbance* disturbance) {
  active = disturbance;
}

} // namespace blactl::campaign

#ifndef BLACTL_SANITIZED

namespace blactl::campaign {
namespace {

/// Whether a call to this file fails now.
bool fails(int descriptor, int error) {
  if (active == nullptr || descriptor == STDOUT_FILENO || descriptor == STDERR_FILENO) {
    return false;
  }
  if (!active->strikes()) {
    return false;
  }
  errno = error;
  return true;
}

constexpr int no_descriptor = -1;

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name)); // NOLINT: that is what dlsym gives
}

} // namespace
} // namespace blactl::campaign

using blactl::campaign::fails;
using blactl::campaign::next;
using blactl::campaign::no_descriptor;

extern "C" {

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  static const auto real = next<int(const char*, int, ...)>("open64");
  return fails(no_descriptor, EMFILE) ? -1 : real(path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  static const auto real = next<int(const char*, int, ...)>("open");
  return fails(no_descriptor, EMFILE) ? -1 : real(path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  static const auto real = next<ssize_t(int, const void*, size_t)>("write");
  return fails(descriptor, ENOSPC) ? -1 : real(descriptor, data, size);
}

ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t offset) {
  static const auto real = next<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  return fails(descriptor, ENOSPC) ? -1 : real(descriptor, data, size, offset);
}

int fsync(int descriptor) {
  static const auto real = next<int(int)>("fsync");
  return fails(descriptor, EIO) ? -1 : real(descriptor);
}

int fdatasync(int descriptor) {
  static const auto real = next<int(int)>("fdatasync");
  return fails(descriptor, EIO) ? -1 : real(descriptor);
}

int link(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("link");
  return fails(no_descriptor, EIO) ? -1 : real(from, to);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("rename");
  return fails(no_descriptor, EIO) ? -1 : real(from, to);
}

int unlink(const char* path) noexcept {
  static const auto real = next<int(const char*)>("unlink");
  return fails(no_descriptor, EIO) ? -1 : real(path);
}

int flock(int descriptor, int operation) noexcept {
  static const auto real = next<int(int, int)>("flock");
  return fails(descriptor, EIO) ? -1 : real(descriptor, operation);
}

int ppoll(pollfd* all, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  static const auto real = next<int(pollfd*, nfds_t, const timespec*, const sigset_t*)>("ppoll");
  return fails(no_descriptor, EINTR) ? -1 : real(all, count, timeout, mask);
}

} // extern "C"

#endif
