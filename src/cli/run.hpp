#pragma once
// The whole program but for main(): from arguments to an exit status.

#include <span>
#include <string>

namespace blactl::cli {

/// Runs the command line without the program's name and prints what it has to say.
[[nodiscard]] int run(std::span<const std::string> arguments);

} // namespace blactl::cli
