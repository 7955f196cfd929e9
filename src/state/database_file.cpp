#include "state/database_file.hpp"

#include "blactl/base/system_error.hpp"

#include "state/database_errors.hpp"
#include "state/obstacle.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace blactl::state {
namespace {

bool has_content(const std::string& path) {
  struct stat info{};
  return lstat(path.c_str(), &info) == 0 && info.st_size > 0;
}

/// The log beside a database: the journal of a transaction that has not ended, or that of
/// write-ahead mode, in which older versions left their files; empty: there is none.
std::string log_of(const std::string& path) {
  for (const char* suffix : {"-journal", "-wal"}) {
    if (has_content(path + suffix)) {
      return path + suffix;
    }
  }
  return {};
}

/// Checks the header only, before SQLite can create files beside it (Database File Format, 1.3).
bool is_ours(const Database::Header& header, const DatabaseFormat& format) {
  constexpr std::string_view magic("SQLite format 3\0", 16);
  constexpr std::size_t id_offset = 68;
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < sizeof id; ++i) {
    id = id << 8 | header[id_offset + i];
  }
  return std::ranges::equal(magic, std::span(header).first<16>(),
                            [](char a, std::uint8_t b) { return a == static_cast<char>(b); }) &&
         id == static_cast<std::uint32_t>(format.application_id);
}

/// Checks the read and write versions in the header: 1 and 2 are those of today's SQLite. A newer
/// write version would otherwise look like missing permission.
bool is_known_to_sqlite(const Database::Header& header) {
  constexpr std::size_t write_version = 18;
  constexpr std::size_t read_version = 19;
  return header[write_version] <= 2 && header[read_version] <= 2;
}

DatabaseName name_of(const std::string& path, const DatabaseFormat& format) {
  return {path, format.what, format.way_back};
}

Result<void> check_header(const Database& database, const DatabaseFormat& format) {
  const auto header = database.header();
  if (!header) {
    return std::unexpected(header.error());
  }
  if (!is_ours(*header, format)) {
    return std::unexpected(errors::foreign(database.name()));
  }
  if (!is_known_to_sqlite(*header)) {
    return std::unexpected(errors::damaged(database.name(), sqlite3_errstr(SQLITE_NOTADB)));
  }
  return {};
}

/// The version of the file, from 1 to that of `format`.
Result<std::size_t> version_of(const Database& database, const DatabaseFormat& format) {
  Statement statement(database, "PRAGMA user_version");
  const auto row = statement.step();
  if (!row) {
    return std::unexpected(row.error());
  }
  const std::int64_t version = *row ? statement.integer(0) : 0;
  if (version > format.version) {
    return std::unexpected(errors::newer(database.name(), version, format.version));
  }
  if (version < 1) {
    return std::unexpected(
        errors::damaged(database.name(), fmt::format("user_version {}", version)));
  }
  return static_cast<std::size_t>(version);
}

/// Runs a statement that must return one row with the expected text; anything else is damage.
Result<void> expect_one(const Database& database, std::string_view sql, std::string_view expected) {
  Statement statement(database, sql);
  for (int count = 0;; ++count) {
    const auto row = statement.step();
    if (!row) {
      return std::unexpected(row.error());
    }
    if (*row && (count > 0 || statement.text(0) != expected)) {
      return std::unexpected(errors::damaged(database.name(), statement.text(0)));
    }
    if (!*row) {
      return count == 1 ? Result<void>()
                        : std::unexpected(errors::damaged(database.name(), "no such table"));
    }
  }
}

Result<void> check_schema(const Database& database, std::string_view schema) {
  return expect_one(database, "SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL", schema);
}

/// Version and schema, of one moment: another process may upgrade the file in between.
Result<std::size_t> check_content(const Database& database, const DatabaseFormat& format) {
  auto version = version_of(database, format);
  if (!version) {
    return version;
  }
  const bool is_older = *version <= format.older.size();
  const auto good =
      check_schema(database, is_older ? format.older[*version - 1].schema : format.schema);
  return good ? version : std::unexpected(good.error());
}

/// Runs the checks that cost little, however large the file is. Returns the version of the file.
Result<std::size_t> check_form(const Database& database, const DatabaseFormat& format) {
  if (auto header = check_header(database, format); !header) {
    return std::unexpected(header.error());
  }
  if (auto begun = database.execute("BEGIN"); !begun) {
    return std::unexpected(begun.error());
  }
  auto version = check_content(database, format);
  const auto ended = database.execute("COMMIT");
  return version && !ended ? std::unexpected(ended.error()) : version;
}

/// Brings a file to the present version, all of it or nothing.
Result<void> upgrade(const Database& database, const DatabaseFormat& format) {
  if (auto good = check_all(database); !good) {
    return good;
  }
  return database.transact([&]() -> Result<void> {
    const auto found = version_of(database, format); // another process may have been faster
    if (!found) {
      return std::unexpected(found.error());
    }
    for (std::size_t version = *found; version <= format.older.size(); ++version) {
      const std::string step = fmt::format("{}; PRAGMA user_version = {}",
                                           format.older[version - 1].upgrade, version + 1);
      if (auto done = database.execute(step.c_str()); !done) {
        return done;
      }
    }
    return check_schema(database, format.schema);
  });
}

/// Leaves write-ahead mode, in which files of older versions are: SQLite 3.7.0 to 3.51.2 can lose a
/// committed transaction there when two processes write and checkpoint at once. While another
/// process has the file open, and where it cannot be written, it stays in that mode and is used so.
void leave_write_ahead(const Database& database) {
  [[maybe_unused]] const auto left = database.execute("PRAGMA journal_mode = DELETE");
}

/// With synchronous = EXTRA committed data survives a power cut: the removal of the journal, which
/// is the commit, is synced too. That comes first, since leave_write_ahead() commits.
Result<void> set_up(const Database& database, bool writable) {
  const int obstacle = writable ? obstacle_to(database.name().path) : 0;
  if (obstacle != 0) {
    return std::unexpected(errors::of_system(database.name(), obstacle));
  }
  if (auto set = database.execute("PRAGMA synchronous = EXTRA"); !set) {
    return set;
  }
  leave_write_ahead(database);
  return writable ? Result<void>() : database.execute("PRAGMA query_only = ON");
}

/// Syncs the folder, because the file got its name after SQLite had synced it for the journal.
Result<void> sync_folder_of(const DatabaseName& file) {
  const std::string parent = std::filesystem::path(file.path).parent_path().string();
  const std::string folder = parent.empty() ? "." : parent;
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) {
    close(descriptor);
  }
  return synced ? Result<void>() : std::unexpected(errors::of_system(file, error));
}

Result<void> fill(const std::string& draft, const std::string& path, const DatabaseFormat& format) {
  const auto database = Database::open(draft, name_of(path, format), std::chrono::milliseconds(0));
  if (!database) {
    return std::unexpected(database.error());
  }
  const std::string content =
      fmt::format("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = FULL; BEGIN; "
                  "PRAGMA application_id = {}; PRAGMA user_version = {}; {}; COMMIT",
                  format.application_id, format.version, format.schema);
  return database->execute(content.c_str());
}

/// Refuses a log without its database: a new database would play it back.
Result<void> check_for_logs_of(const std::string& path, const DatabaseFormat& format) {
  const std::string log = log_of(path);
  return log.empty() || has_content(path)
             ? Result<void>()
             : std::unexpected(errors::left_over(name_of(path, format), log));
}

/// A file that is complete from the moment it has its name (0600); false: another has the name.
template <class Fill> Result<bool> put(const DatabaseName& file, Fill fill_draft) {
  std::string draft = file.path + ".XXXXXX";
  const int descriptor = mkostemp(draft.data(), O_CLOEXEC); // 0600
  if (descriptor < 0) {
    return std::unexpected(errors::of_system(file, errno));
  }
  close(descriptor);
  const Result<void> filled = fill_draft(draft);
  // Unlike rename(), link() cannot replace a file that another process has made meanwhile.
  const bool is_named = filled && link(draft.c_str(), file.path.c_str()) == 0;
  const int error = errno;
  unlink(draft.c_str());
  if (!filled) {
    return std::unexpected(filled.error());
  }
  return is_named || error == EEXIST ? Result<bool>(is_named)
                                     : std::unexpected(errors::of_system(file, error));
}

/// All pages, of one moment.
Result<void> copy_pages(const Database& from, const Database& to) {
  constexpr int all_pages = -1;
  constexpr const char* schema = "main";
  sqlite3_backup* backup = sqlite3_backup_init(to.handle(), schema, from.handle(), schema);
  if (backup == nullptr) {
    return std::unexpected(to.failure(sqlite3_errcode(to.handle())));
  }
  sqlite3_backup_step(backup, all_pages);
  const int result = sqlite3_backup_finish(backup); // of the step, too
  return result == SQLITE_OK ? Result<void>() : std::unexpected(to.failure(result));
}

} // namespace

Result<void> check_all(const Database& database) {
  return expect_one(database, "PRAGMA integrity_check(1)", "ok");
}

Result<Database> open_database(const std::string& path, const DatabaseFormat& format, bool writable,
                               std::chrono::milliseconds patience) {
  const bool was_broken_off = !log_of(path).empty(); // before a read rolls it back
  auto database = Database::open(path, name_of(path, format), patience);
  if (!database) {
    return database;
  }
  const auto version = check_form(*database, format);
  auto usable = version ? Result<void>() : std::unexpected(version.error());
  if (usable && was_broken_off) {
    usable = check_all(*database);
  }
  if (usable && *version <= format.older.size()) {
    usable = upgrade(*database, format);
  }
  if (usable) {
    usable = set_up(*database, writable);
  }
  if (!usable) {
    return std::unexpected(usable.error());
  }
  return database;
}

Result<void> make_database(const std::string& path, const DatabaseFormat& format) {
  if (auto clear = check_for_logs_of(path, format); !clear) {
    return clear;
  }
  const auto made = put(name_of(path, format),
                        [&](const std::string& draft) { return fill(draft, path, format); });
  return made ? sync_folder_of(name_of(path, format)) : std::unexpected(made.error());
}

Result<void> copy_database(const Database& database, const std::string& path) {
  const DatabaseName copy{path, database.name().what, database.name().way_back};
  const auto made = put(copy, [&](const std::string& draft) -> Result<void> {
    const auto to = Database::open(draft, copy, std::chrono::milliseconds(0));
    return to ? copy_pages(database, *to) : std::unexpected(to.error());
  });
  if (!made) {
    return std::unexpected(made.error());
  }
  return *made ? sync_folder_of(copy) : std::unexpected(errors::io(copy, system_reason(EEXIST)));
}

Result<Database> make_temporary_database(const DatabaseFormat& format) {
  constexpr const char* in_memory = ":memory:";
  auto database =
      Database::open(in_memory, name_of(in_memory, format), std::chrono::milliseconds(0));
  if (!database) {
    return database;
  }
  if (auto made = database->execute(format.schema.c_str()); !made) {
    return std::unexpected(made.error());
  }
  return database;
}

} // namespace blactl::state
