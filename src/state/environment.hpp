#pragma once
// Folders that environment variables name.

#include <cstdlib>
#include <string>

namespace blactl::state {

[[nodiscard]] inline std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Of a folder. One that is relative or empty is as good as unset (XDG base directory
/// specification): what is shared must not depend on where a process was started.
[[nodiscard]] inline std::string folder_variable(const char* name) {
  std::string value = variable(name);
  return value.starts_with('/') ? value : std::string();
}

} // namespace blactl::state
