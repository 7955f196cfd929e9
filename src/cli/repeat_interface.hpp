#pragma once
// Commands that are offered to a user who typed -i, for the same interface.

#include "cli/options.hpp"

#include <string>

namespace blactl::cli {

/// Adds -i with its value to every command in a hint that uses a bus, if -i was typed: what the
/// environment says holds for that command, too. Not where -i names a file, which takes no changes.
void repeat_interface(std::string& hint, const Shared& shared);

} // namespace blactl::cli
