#include "cli/run.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

/// A standard descriptor closed by the caller must not become the number of a CAN socket, or
/// printed data would go to the bus. Its place is taken by one that refuses to be used.
void occupy_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) < 0) {
      // the lowest free number is this one; it reads as empty, or cannot be written
      (void)open("/dev/null", O_RDONLY | O_CLOEXEC);
    }
  }
}

} // namespace

int main(int argc, char** argv) {
  occupy_standard_descriptors();
  // A reader that leaves is an error of write(), and must not kill this process: `blactl models |
  // head`.
  struct sigaction ignore{};
  ignore.sa_handler = SIG_IGN; // NOLINT: the macro casts
  sigaction(SIGPIPE, &ignore, nullptr);
  // nor must the limit of a file's size (ulimit -f)
  sigaction(SIGXFSZ, &ignore, nullptr);
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  return blactl::cli::run(arguments);
}
