#include "state/sqlite.hpp"

#include "blactl/base/system_error.hpp"

#include "state/obstacle.hpp"

#include <cerrno>

namespace blactl::state {
namespace {

constexpr const char* main_database = "main";

/// The reason given by SQLite, or by the system if that is the cause.
std::string reason_of(sqlite3* handle, int result) {
  const int primary = result & 0xFF;
  const int error = handle != nullptr ? sqlite3_system_errno(handle) : 0;
  const bool is_of_system = primary == SQLITE_IOERR || primary == SQLITE_CANTOPEN;
  return is_of_system && error != 0 ? system_reason(error) : sqlite3_errstr(result);
}

/// The errno of a failure to write. SQLite does not say why a file is read-only (0), and looks for
/// a log that it could not create: then it names the missing file.
int cause(const std::string& path, int error) {
  const int found = error == 0 || error == ENOENT ? obstacle_to(path) : 0;
  return found != 0 ? found : error != 0 ? error : EACCES;
}

} // namespace

Result<Database> Database::open(const std::string& path, DatabaseName told_as,
                                std::chrono::milliseconds patience) {
  constexpr int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOFOLLOW | SQLITE_OPEN_NOMUTEX |
                        SQLITE_OPEN_PRIVATECACHE | SQLITE_OPEN_EXRESCODE;
  sqlite3* handle = nullptr;
  const int result = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  Database database(handle, std::move(told_as));
  if (result != SQLITE_OK) {
    return std::unexpected(database.failure(result));
  }
  sqlite3_busy_timeout(handle, static_cast<int>(patience.count()));
  // Closing must not write the log of an older version (-wal) into a file that may be damaged.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  return database;
}

Result<Database::Header> Database::header() const {
  sqlite3_file* file = nullptr;
  int result = sqlite3_file_control(handle(), main_database, SQLITE_FCNTL_FILE_POINTER,
                                    static_cast<void*>(&file));
  Header header{};
  if (result == SQLITE_OK) {
    result = file->pMethods->xRead(file, header.data(), static_cast<int>(header.size()), 0);
  }
  if (result != SQLITE_OK && result != SQLITE_IOERR_SHORT_READ) {
    return std::unexpected(failure(result));
  }
  return header;
}

Result<void> Database::execute(const char* sql) const {
  const int result = sqlite3_exec(handle(), sql, nullptr, nullptr, nullptr);
  if (result != SQLITE_OK) {
    return std::unexpected(failure(result));
  }
  return {};
}

/// Rolls back unless the failure already ended the transaction.
void Database::roll_back_if_open() const {
  if (sqlite3_get_autocommit(handle()) == 0) {
    sqlite3_exec(handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

/// Any code not listed means that the database is not the one we made.
Error Database::failure(int result) const {
  const std::string reason = reason_of(handle(), result);
  const int error = sqlite3_system_errno(handle());
  switch (result) {
  case SQLITE_CANTOPEN_SYMLINK: return errors::link(told_as_);
  case SQLITE_READONLY_DBMOVED: return errors::moved_away(told_as_);
  case SQLITE_READONLY_ROLLBACK: return errors::broken_off(told_as_, cause(told_as_.path, 0));
  case SQLITE_IOERR_DELETE: return errors::broken_off(told_as_, error); // of the journal
  default: break;
  }
  switch (result & 0xFF) {
  case SQLITE_BUSY:
  case SQLITE_LOCKED:
  case SQLITE_PROTOCOL: return errors::busy(told_as_);
  case SQLITE_FULL:
  case SQLITE_IOERR:
  case SQLITE_NOMEM: return errors::io(told_as_, reason);
  case SQLITE_PERM:
  case SQLITE_AUTH: return errors::denied(told_as_, reason);
  case SQLITE_READONLY: return errors::denied(told_as_, system_reason(cause(told_as_.path, 0)));
  case SQLITE_CANTOPEN: return errors::of_system(told_as_, cause(told_as_.path, error));
  default: return errors::damaged(told_as_, reason);
  }
}

Statement::Statement(const Database& database, std::string_view sql)
    : database_(database),
      failed_(sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()),
                                 &statement_, nullptr)) {}

Statement::~Statement() {
  sqlite3_finalize(statement_);
}

Statement& Statement::bind(std::int64_t value) {
  note(sqlite3_bind_int64(statement_, ++bound_, value));
  return *this;
}

Statement& Statement::bind_real(double value) {
  note(sqlite3_bind_double(statement_, ++bound_, value));
  return *this;
}

Statement& Statement::bind(std::span<const std::uint8_t> value) {
  const void* data = value.empty() ? "" : static_cast<const void*>(value.data()); // null is no blob
  note(sqlite3_bind_blob64(statement_, ++bound_, data, value.size(), nullptr));
  return *this;
}

Statement& Statement::bind(std::string_view value) {
  note(sqlite3_bind_text64(statement_, ++bound_, value.data(), value.size(), nullptr, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(std::nullopt_t /*null*/) {
  note(sqlite3_bind_null(statement_, ++bound_));
  return *this;
}

Result<bool> Statement::step() {
  const int result = failed_ == SQLITE_OK ? sqlite3_step(statement_) : failed_;
  if (result != SQLITE_ROW && result != SQLITE_DONE) {
    return std::unexpected(database_.failure(result));
  }
  return result == SQLITE_ROW;
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

double Statement::real(int column) const {
  return sqlite3_column_double(statement_, column);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::int64_t Statement::integer(int column, std::int64_t first, std::int64_t last) {
  const std::int64_t value = integer(column);
  if (value < first || value > last) {
    reject();
  }
  return value;
}

std::span<const std::uint8_t> Statement::bytes(int column) const {
  const auto* begin = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
  return {begin, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::string_view Statement::text(int column) const {
  const auto all = bytes(column);
  return {reinterpret_cast<const char*>(all.data()), all.size()};
}

} // namespace blactl::state
