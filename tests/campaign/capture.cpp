#include "capture.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <stdexcept>

namespace blactl::campaign {
namespace {

/// Files in memory, one for each; emptied rather than made anew.
int memory_of(int descriptor) {
  static const std::array<int, 2> files{memfd_create("out", MFD_CLOEXEC),
                                        memfd_create("err", MFD_CLOEXEC)};
  return files.at(descriptor == STDOUT_FILENO ? 0 : 1);
}

int redirect(int descriptor) {
  const int before = fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
  const int memory = memory_of(descriptor);
  if (before < 0 || ftruncate(memory, 0) != 0 || lseek(memory, 0, SEEK_SET) != 0 ||
      dup2(memory, descriptor) != descriptor) {
    throw std::runtime_error("cannot redirect the output");
  }
  return before;
}

std::string content(int file) {
  std::string text(static_cast<std::size_t>(lseek(file, 0, SEEK_END)), '\0');
  const auto got = pread(file, text.data(), text.size(), 0);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

void give_back(int descriptor, int before) {
  dup2(before, descriptor);
  close(before);
}

} // namespace

Capture::Capture() {
  std::fflush(stdout);
  out_ = redirect(STDOUT_FILENO);
  err_ = redirect(STDERR_FILENO);
}

Capture::~Capture() {
  give_back(STDOUT_FILENO, out_);
  give_back(STDERR_FILENO, err_);
}

std::pair<std::string, std::string> Capture::taken() const {
  return {content(memory_of(STDOUT_FILENO)), content(memory_of(STDERR_FILENO))};
}

} // namespace blactl::campaign
