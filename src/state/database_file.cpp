#include "state/database_file.hpp"

#include "blactl/base/system_error.hpp"

#include "state/database_errors.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <span>
#include <string_view>

namespace blactl::state {
namespace {

// Files beside a database: the log of write-ahead mode and its index, and that of other modes.
constexpr std::string_view log_suffix = "-wal";
constexpr std::array suffixes{log_suffix, std::string_view("-shm"), std::string_view("-journal")};

std::string beside(const std::string& path, std::string_view suffix) {
  return path + std::string(suffix);
}

bool has_content(const std::string& path) {
  struct stat info{};
  return lstat(path.c_str(), &info) == 0 && info.st_size > 0;
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

Result<void> check_version(const Database& database, const DatabaseFormat& format) {
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
  return {};
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

/// Runs the full check, since PRAGMA quick_check does not compare a table with its index, which
/// detects a changed byte in an ID. Our databases are small.
Result<void> check(const Database& database, const DatabaseFormat& format) {
  auto good = check_header(database, format);
  if (good) {
    good = check_version(database, format);
  }
  if (good) {
    good =
        expect_one(database, "SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL", format.schema);
  }
  if (good) {
    good = expect_one(database, "PRAGMA integrity_check(1)", "ok");
  }
  return good;
}

/// In write-ahead mode (WAL) readers and the writer do not wait for each other. Some network file
/// systems do not support it.
Result<void> write_ahead(const Database& database) {
  Statement statement(database, "PRAGMA journal_mode = WAL");
  const auto row = statement.step();
  if (!row) {
    return std::unexpected(row.error());
  }
  return *row && statement.text(0) == "wal"
             ? Result<void>()
             : std::unexpected(errors::io(database.name(), system_reason(ENOTSUP)));
}

/// With synchronous = FULL committed data survives a power cut.
Result<void> set_up(const Database& database, bool writable) {
  if (!writable) {
    return database.execute("PRAGMA query_only = ON");
  }
  if (database.is_read_only()) {
    return std::unexpected(database.failure(SQLITE_READONLY));
  }
  if (auto set = write_ahead(database); !set) {
    return set;
  }
  return database.execute("PRAGMA synchronous = FULL");
}

/// Syncs the folder, because the file got its name after SQLite had synced it for the journal.
Result<void> sync_folder_of(const std::string& path, const DatabaseFormat& format) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) {
    close(descriptor);
  }
  return synced ? Result<void>() : std::unexpected(errors::of_system(name_of(path, format), error));
}

Result<void> fill(const std::string& draft, const std::string& path, const DatabaseFormat& format) {
  const auto database = Database::open(draft, name_of(path, format), std::chrono::milliseconds(0));
  if (!database) {
    return std::unexpected(database.error());
  }
  const std::string content =
      fmt::format("PRAGMA synchronous = FULL; BEGIN; PRAGMA application_id = {}; "
                  "PRAGMA user_version = {}; {}; COMMIT",
                  format.application_id, format.version, format.schema);
  auto filled = database->execute(content.c_str());
  if (filled) {
    filled = write_ahead(*database);
  }
  return filled;
}

/// Refuses a log without its database: a new database would play it back.
Result<void> check_for_logs_of(const std::string& path, const DatabaseFormat& format) {
  for (const std::string_view suffix : suffixes) {
    const std::string log = beside(path, suffix);
    if (suffix != "-shm" && has_content(log) && !has_content(path)) {
      return std::unexpected(errors::left_over(name_of(path, format), log));
    }
  }
  return {};
}

} // namespace

Result<Database> open_database(const std::string& path, const DatabaseFormat& format, bool writable,
                               std::chrono::milliseconds patience) {
  auto database = Database::open(path, name_of(path, format), patience);
  if (!database) {
    return database;
  }
  auto usable = check(*database, format);
  if (usable) {
    usable = set_up(*database, writable);
  }
  // Without a log, closing writes nothing and removes the files that SQLite created beside it.
  database->leave_as_it_is(!usable && has_content(beside(path, log_suffix)));
  if (!usable) {
    return std::unexpected(usable.error());
  }
  return database;
}

Result<void> make_database(const std::string& path, const DatabaseFormat& format) {
  if (auto clear = check_for_logs_of(path, format); !clear) {
    return clear;
  }
  std::string draft = path + ".XXXXXX";
  const int descriptor = mkostemp(draft.data(), O_CLOEXEC); // 0600
  if (descriptor < 0) {
    return std::unexpected(errors::of_system(name_of(path, format), errno));
  }
  close(descriptor);
  auto made = fill(draft, path, format);
  // Unlike rename(), link() cannot replace a file that another process has made meanwhile.
  if (made && link(draft.c_str(), path.c_str()) != 0 && errno != EEXIST) {
    made = std::unexpected(errors::of_system(name_of(path, format), errno));
  }
  unlink(draft.c_str());
  for (const std::string_view suffix : suffixes) {
    unlink(beside(draft, suffix).c_str());
  }
  return made ? sync_folder_of(path, format) : made;
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
