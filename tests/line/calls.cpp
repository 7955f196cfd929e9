// System calls of a station, as another machine would have them: preloaded (LD_PRELOAD), it acts by
// the environment.
//
//   FAKED_CLOCK=5         what adjtimex() returns: 5 is a clock that nothing sets
//   FAKED_FILES=0x6969    on which file system everything is (statfs(2), f_type)
//   FAKED_FULL=12         from the 12th write to a database on, there is no room
//   FAKED_KILL=before 12  dies by SIGKILL before, or after, the 12th call that orders a database on
//                         the disk: sync, cut, rename, link, unlink

#include <dlfcn.h>
#include <signal.h>
#include <sys/timex.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

const char* told(const char* name) {
  const char* text = std::getenv(name);
  return text != nullptr && *text != '\0' ? text : nullptr;
}

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name)); // NOLINT: that is what dlsym gives
}

void die() {
  kill(getpid(), SIGKILL);
}

/// One call in the order of a database.
template <class Call> auto ordered(Call call) {
  static long count = 0;
  static const char* const when = told("FAKED_KILL");
  static const bool is_before = when != nullptr && std::strncmp(when, "before ", 7) == 0;
  static const long chosen = when != nullptr ? std::atol(std::strchr(when, ' ')) : 0;
  ++count;
  if (count == chosen && is_before) {
    die();
  }
  const auto result = call();
  if (count == chosen) {
    die();
  }
  return result;
}

bool is_full() {
  static long count = 0;
  static const char* const text = told("FAKED_FULL");
  return text != nullptr && ++count >= std::atol(text);
}

} // namespace

extern "C" {

int adjtimex(timex* state) noexcept {
  static const auto real = next<int(timex*)>("adjtimex");
  const char* clock = told("FAKED_CLOCK");
  return clock != nullptr ? std::atoi(clock) : real(state);
}

int statfs(const char* path, struct statfs* about) noexcept {
  static const auto real = next<int(const char*, struct statfs*)>("statfs");
  const int result = real(path, about);
  if (const char* type = told("FAKED_FILES"); type != nullptr && result == 0) {
    about->f_type = std::strtol(type, nullptr, 0);
  }
  return result;
}

ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t offset) {
  static const auto real = next<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  if (is_full()) {
    errno = ENOSPC;
    return -1;
  }
  return real(descriptor, data, size, offset);
}

int fsync(int descriptor) {
  static const auto real = next<int(int)>("fsync");
  return ordered([&] { return real(descriptor); });
}

int fdatasync(int descriptor) {
  static const auto real = next<int(int)>("fdatasync");
  return ordered([&] { return real(descriptor); });
}

int ftruncate64(int descriptor, off64_t size) noexcept {
  static const auto real = next<int(int, off64_t)>("ftruncate64");
  return ordered([&] { return real(descriptor, size); });
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("rename");
  return ordered([&] { return real(from, to); });
}

int link(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("link");
  return ordered([&] { return real(from, to); });
}

int unlink(const char* path) noexcept {
  static const auto real = next<int(const char*)>("unlink");
  return ordered([&] { return real(path); });
}

} // extern "C"
