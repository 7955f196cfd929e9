#pragma once
// The whole program but for main(): from arguments to an exit status.

#include <functional>
#include <span>
#include <string>

namespace blactl::cli {

/// Runs the command line without the program's name and prints what it has to say. Throws nothing:
/// what is thrown is a fault of this program, told as `internal`.
[[nodiscard]] int run(std::span<const std::string> arguments);

/// The exit status that `work` gives; where it throws, 1, with the document that `arguments` ask
/// for.
[[nodiscard]] int guarded(std::span<const std::string> arguments,
                          const std::function<int()>& work) noexcept;

} // namespace blactl::cli
