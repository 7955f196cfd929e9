#include "blactl/state/state_folder.hpp"

#include "state/environment.hpp"

#include <pwd.h>
#include <unistd.h>

namespace blactl::state {
namespace {

/// Of this user, also where HOME is unset (services, cron); empty: none.
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

} // namespace blactl::state
