#pragma once
// Folders named by environment variables.

#include <cstdlib>
#include <string>

namespace blactl::state {

[[nodiscard]] inline std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// The folder named by a variable. A relative or empty one counts as unset (XDG base directory
/// specification): shared files must not depend on the working directory.
[[nodiscard]] inline std::string folder_variable(const char* name) {
  std::string value = variable(name);
  return value.starts_with('/') ? value : std::string();
}

} // namespace blactl::state
