#pragma once
// SQLite with our errors: an open database file, and statements on it.

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

/// An open database file. Errors of its functions: bad_file, permission, io, busy.
class Database {
 public:
  /// The first bytes of every database (SQLite, "Database File Format", 1.3).
  using Header = std::array<std::uint8_t, 100>;

  /// Does not read or change the file yet; refuses a symbolic link. `path` is absolute and contains
  /// no link. `told_as`: the name of the file in errors.
  [[nodiscard]] static Result<Database> open(const std::string& path, DatabaseName told_as,
                                             std::chrono::milliseconds patience);

  /// The header as in the file, padded with zeros. SQLite reads it: closing a descriptor of our own
  /// would drop all POSIX locks of this process on the file.
  [[nodiscard]] Result<Header> header() const;

  [[nodiscard]] Result<void> execute(const char* sql) const;

  /// Does `work` in one write transaction. Its result is returned only after it is on disk; if it
  /// is an error, or the commit fails, nothing has changed.
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

  /// Whether closing must not change the file, not even by committed transactions in its log
  /// (-wal). This is the default until called, and after damage was found.
  void leave_as_it_is(bool leave) const;

  [[nodiscard]] bool is_read_only() const;

  /// The error for a result code of SQLite.
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

/// One statement. The first step reports any earlier failure.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);

  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  ~Statement();

  /// Sets the next parameter. Bytes and text must live as long as the statement.
  Statement& bind(std::int64_t value);

  Statement& bind(std::same_as<double> auto value) { return bind_real(value); } // not for integers

  Statement& bind(std::span<const std::uint8_t> value);
  Statement& bind(std::string_view value);
  Statement& bind(std::nullopt_t null);

  /// Moves to the next row; false: there is none left.
  [[nodiscard]] Result<bool> step();

  /// Calls `take` on each row until it returns false.
  template <class Take> [[nodiscard]] Result<void> each(Take take) {
    for (;;) {
      const auto row = step();
      if (!row) {
        return std::unexpected(row.error());
      }
      if (!*row || !take()) {
        return {};
      }
    }
  }

  /// What `read` makes of the first row; empty: there is none.
  template <class Read>
  [[nodiscard]] Result<std::optional<std::invoke_result_t<Read>>> first(Read read) {
    const auto row = step();
    if (!row) {
      return std::unexpected(row.error());
    }
    return *row ? std::optional(read()) : std::nullopt;
  }

  /// Runs the statement and ignores its rows.
  [[nodiscard]] Result<void> run() {
    return each([] { return true; });
  }

  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  /// Valid until the next step.
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
