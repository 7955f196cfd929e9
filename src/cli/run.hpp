#pragma once
// The whole program except main(): from arguments to an exit status.

#include "cli/interface/bus_factory.hpp"

#include <functional>
#include <span>
#include <string>

namespace blactl::cli {

/// Runs the command line without the program's name and prints its output. Throws nothing: an
/// exception is a bug of this program, reported as `internal`. `opener`: of the bus.
[[nodiscard]] int run(std::span<const std::string> arguments, const BusOpener& opener = open_bus);

/// The exit status of `work`; if it throws, 1, with the document that `arguments` ask for.
[[nodiscard]] int guarded(std::span<const std::string> arguments,
                          const std::function<int()>& work) noexcept;

} // namespace blactl::cli
