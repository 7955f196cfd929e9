#include "blactl/state/state_folder.hpp"

#include "state/environment.hpp"
#include "state/formats.hpp"
#include "state/obstacle.hpp"
#include "state/state_file.hpp"
#include "state/texts.hpp"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
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

std::array<const DatabaseFormat*, 5> formats() {
  return {&allocations_format(), &counters_format(), &ledger_format(), &proofs_format(),
          &snapshots_format()};
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
  const std::string name = printable(nearest.string());
  switch (std::filesystem::is_directory(nearest, error) ? obstacle_in(nearest.string()) : ENOTDIR) {
  case 0: return {};
  case ENOSPC:
    return fail(Code::io, say<texts::state_folder_full>(name),
                say<texts::state_folder_full_hint>(name));
  default:
    return fail(Code::permission, say<texts::state_folder_closed>(name),
                say<texts::no_state_folder_hint>());
  }
}

std::vector<Error> check_state_files(const std::string& folder) {
  std::vector<Error> found;
  if (folder.empty() || access((folder + "/.").c_str(), X_OK) != 0) {
    return found;
  }
  for (const DatabaseFormat* format : formats()) {
    const auto file = StateFile::open(folder, *format, Access::read, usual_patience);
    const auto good = file ? file->check() : std::unexpected(file.error());
    if (!good) {
      found.push_back(good.error());
    }
  }
  return found;
}

bool is_state_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
  const fs::path folder = state_folder();
  const bool is_inside = fs::equivalent(whole.parent_path(), folder, error) ||
                         fs::equivalent(whole.parent_path(), folder / simulated_folder, error);
  return is_inside && std::ranges::any_of(formats(), [&](const DatabaseFormat* format) {
           return whole.filename().string().starts_with(format->file);
         });
}

} // namespace blactl::state
