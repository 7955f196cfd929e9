#pragma once
// SQLite with errors of ours: a database file in use, and statements on it.

#include "blactl/base/error.hpp"

#include "state/database_errors.hpp"

#include <sqlite3.h>

#include <array>
#include <chrono>
#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace blactl::state {

/// A database file that is there, in use. Errors of its functions: bad_file, permission, io, busy.
class Database {
 public:
  /// The first bytes of every database (SQLite, "Database File Format", 1.3).
  using Header = std::array<std::uint8_t, 100>;

  /// Reads and changes nothing of the file yet; a symbolic link is refused. `path` is absolute and
  /// no folder of it is a link. `told_as`: the file that errors name.
  [[nodiscard]] static Result<Database> open(const std::string& path, DatabaseName told_as,
                                             std::chrono::milliseconds patience);

  /// As it lies in the file, filled up with zeros. SQLite reads it: a descriptor of our own would
  /// drop all POSIX locks of this process on the file when it is closed.
  [[nodiscard]] Result<Header> header() const;

  [[nodiscard]] Result<void> execute(const char* sql) const;

  /// Does `work` in one write transaction. What it returns is told only after it is on the disk; if
  /// that is an error, or the commit fails, nothing has changed.
  template <class Work> [[nodiscard]] std::invoke_result_t<Work> transact(Work work) const {
    if (auto begun = begin(); !begun) {
      return std::unexpected(std::move(begun.error()));
    }
    std::invoke_result_t<Work> result = work();
    if (result) {
      if (auto committed = execute("COMMIT"); !committed) {
        result = std::unexpected(std::move(committed.error()));
      }
    }
    roll_back_if_open();
    return result;
  }

  /// Whether the file must not be changed when it is closed, not even by what committed
  /// transactions left in its log (-wal). So it is until this is called, and after damage was
  /// found.
  void leave_as_it_is(bool leave) const;

  [[nodiscard]] bool is_read_only() const;

  /// What a result code of SQLite means for a person.
  [[nodiscard]] Error failure(int result) const;

  [[nodiscard]] const DatabaseName& name() const { return told_as_; }

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }

 private:
  struct Closer {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };

  Database(sqlite3* handle, DatabaseName told_as) : handle_(handle), told_as_(std::move(told_as)) {}

  [[nodiscard]] Result<void> begin() const;
  void roll_back_if_open() const;

  std::unique_ptr<sqlite3, Closer> handle_;
  DatabaseName told_as_;
};

/// One statement. What fails before its first step is told by that.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);

  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  ~Statement();

  /// Sets the next parameter. Bytes and text must live as long as the statement.
  Statement& bind(std::int64_t value);

  Statement& bind(std::same_as<double> auto value) { return bind_real(value); } // no integer is one

  Statement& bind(std::span<const std::uint8_t> value);
  Statement& bind(std::string_view value);
  Statement& bind(std::nullopt_t null);

  /// True: it stands on the next row; false: there is none left.
  [[nodiscard]] Result<bool> step();

  /// Runs it, whatever rows it gives.
  [[nodiscard]] Result<void> run();

  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  /// Until the next step.
  [[nodiscard]] std::span<const std::uint8_t> bytes(int column) const;
  [[nodiscard]] std::string_view text(int column) const;

 private:
  Statement& bind_real(double value);

  void note(int result) { failed_ = failed_ == SQLITE_OK ? result : failed_; }

  const Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
  int failed_;
};

} // namespace blactl::state
