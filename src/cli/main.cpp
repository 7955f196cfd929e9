#include "run.hpp"

#include <signal.h>

#include <string>
#include <vector>

int main(int argc, char** argv) {
  // A reader that leaves is an error of write(), not the end of this process: `blactl models |
  // head`.
  struct sigaction ignore{};
  ignore.sa_handler = SIG_IGN; // NOLINT: the macro casts
  sigaction(SIGPIPE, &ignore, nullptr);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  return blactl::cli::run(arguments);
}
