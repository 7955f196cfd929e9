#include "state/state_file.hpp"

#include "state/database_errors.hpp"
#include "state/obstacle.hpp"
#include "state/texts.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace blactl::state {
namespace {

namespace fs = std::filesystem;

/// The path without symbolic links: SQLite is told to follow none and would refuse a link anywhere
/// in the path, but /home may be one.
std::string path_in(const std::string& folder, const std::string& file) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(fs::absolute(folder), error);
  return ((error ? fs::path(folder) : real) / file).string();
}

/// Creates the folder of the file, if missing, as private.
Result<void> make_folder(const DatabaseName& file) {
  const fs::path folder = fs::path(file.path).parent_path();
  std::error_code ignored; // only creating the folder itself matters
  fs::create_directories(folder.parent_path(), ignored);
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    return std::unexpected(errors::of_system(file, errno));
  }
  return {};
}

/// Whether the file exists. Errors: something else does.
Result<bool> is_there(const DatabaseName& file) {
  struct stat info{};
  if (lstat(file.path.c_str(), &info) != 0) {
    return errno == ENOENT ? Result<bool>(false) : std::unexpected(errors::of_system(file, errno));
  }
  if (S_ISLNK(info.st_mode)) {
    return std::unexpected(errors::link(file));
  }
  return S_ISREG(info.st_mode) ? Result<bool>(true) : std::unexpected(errors::foreign(file));
}

/// Creates the file if it is missing and `access` is write; returns whether it exists then.
Result<bool> provide(const DatabaseName& file, const DatabaseFormat& format, Access access) {
  const bool writes = access == Access::write;
  if (writes) {
    if (auto made = make_folder(file); !made) {
      return std::unexpected(made.error());
    }
    if (const fs::path folder = fs::path(file.path).parent_path();
        format.is_local && is_on_network(folder.string())) {
      return fail(Code::state,
                  say<texts::state_on_network>(printable(folder.string()),
                                               choose(format.what.en, format.what.ja)),
                  say<texts::state_on_network_hint>());
    }
  }
  const auto there = is_there(file);
  if (!there || *there || !writes) {
    return there;
  }
  if (auto made = make_database(file.path, format); !made) {
    return std::unexpected(made.error());
  }
  return is_there(file);
}

} // namespace

Result<StateFile> StateFile::open(const std::string& folder, const DatabaseFormat& format,
                                  Access access, std::chrono::milliseconds patience) {
  if (folder.empty()) {
    return fail(Code::state, say<texts::no_state_folder>(), say<texts::no_state_folder_hint>());
  }
  std::string path = path_in(folder, format.file);
  const auto there = provide({path, format.what, format.way_back}, format, access);
  if (!there) {
    return std::unexpected(there.error());
  }
  if (!*there) {
    return StateFile(std::move(path), format, std::nullopt);
  }
  auto database = open_database(path, format, access == Access::write, patience);
  if (!database) {
    return std::unexpected(database.error());
  }
  return StateFile(std::move(path), format, std::move(*database));
}

Result<StateFile> StateFile::unshared(const DatabaseFormat& format) {
  auto database = make_temporary_database(format);
  if (!database) {
    return std::unexpected(database.error());
  }
  return StateFile({}, format, std::move(*database));
}

Result<void> StateFile::check() const {
  return database_ ? check_all(*database_) : Result<void>();
}

Result<void> StateFile::copy_to(const std::string& path) const {
  return database_ ? copy_database(*database_, path)
                   : std::unexpected(Error{Code::state, say<texts::nothing_to_copy>(path_),
                                           say<texts::nothing_to_copy_hint>(), std::nullopt});
}

/// The error of SQLite for a file opened read-only.
Error StateFile::not_writable() const {
  return errors::denied({path_, format_->what, format_->way_back}, sqlite3_errstr(SQLITE_READONLY));
}

} // namespace blactl::state
