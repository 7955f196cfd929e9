#include "blactl/state/state_folder.hpp"

#include "state/environment.hpp"
#include "state/texts.hpp"

#include <pwd.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace blactl::state {
namespace {

/// This user's home folder, even if HOME is unset (services, cron); empty: none.
std::string home_folder() {
  if (std::string home = folder_variable("HOME"); !home.empty()) {
    return home;
  }
  const passwd* entry = getpwuid(geteuid());
  return entry != nullptr && entry->pw_dir != nullptr && entry->pw_dir[0] == '/' ? entry->pw_dir
                                                                                 : "";
}

} // namespace

std::string state_folder() {
  if (std::string folder = variable("BLACTL_STATE_DIR"); !folder.empty()) {
    return folder;
  }
  if (const std::string home = folder_variable("XDG_STATE_HOME"); !home.empty()) {
    return home + "/blactl";
  }
  const std::string home = home_folder();
  return home.empty() ? std::string() : home + "/.local/state/blactl";
}

Result<void> check_state_folder(const std::string& folder) {
  if (folder.empty()) {
    return fail(Code::state, say<texts::no_state_folder>(), say<texts::no_state_folder_hint>());
  }
  std::error_code error;
  std::filesystem::path nearest = std::filesystem::absolute(folder, error);
  while (!std::filesystem::exists(nearest, error) && nearest.has_relative_path()) {
    nearest = nearest.parent_path();
  }
  const bool is_folder = std::filesystem::is_directory(nearest, error);
  if (!is_folder || access(nearest.c_str(), W_OK | X_OK) != 0) {
    return fail(Code::permission, say<texts::state_folder_closed>(printable(nearest.string())),
                say<texts::no_state_folder_hint>());
  }
  return {};
}

} // namespace blactl::state
