#pragma once
// SQLite with our errors: an open database file, and statements on it.

#include "blactl/base/error.hpp"

#include "state/database_errors.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
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
  /// no link. `told_as`: the name of the file in errors. `patience`: for each wait for another
  /// process, to read or to write.
  [[nodiscard]] static Result<Database> open(const std::string& path, DatabaseName told_as,
                                             std::chrono::milliseconds patience);

  /// The header as in the file, padded with zeros. SQLite reads it: closing a descriptor of our own
  /// would drop all POSIX locks of this process on the file.
  [[nodiscard]] Result<Header> header() const;

  [[nodiscard]] Result<void> execute(const char* sql) const;

  /// Does `work` in one write transaction. Its result is returned only after it is on disk; if it
  /// is an error, or the commit fails, nothing has changed.
  template <class Work> [[nodiscard]] std::invoke_result_t<Work> transact(Work work) const {
    if (auto begun = execute("BEGIN IMMEDIATE"); !begun) {
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

  /// The error for a result code of SQLite.
  [[nodiscard]] Error failure(int result) const;

  [[nodiscard]] const DatabaseName& name() const { return told_as_; }

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }

 private:
  struct Closer {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };

  Database(sqlite3* handle, DatabaseName told_as) : handle_(handle), told_as_(std::move(told_as)) {}

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
        return failed_ == SQLITE_OK ? Result<void>() : std::unexpected(database_.failure(failed_));
      }
    }
  }

  /// What `read` makes of the first row; empty: there is none.
  template <class Read>
  [[nodiscard]] Result<std::optional<std::invoke_result_t<Read>>> first(Read read) {
    std::optional<std::invoke_result_t<Read>> found;
    const auto done = each([&] {
      found = read();
      return false;
    });
    return done ? Result<std::optional<std::invoke_result_t<Read>>>(std::move(found))
                : std::unexpected(done.error());
  }

  /// Runs the statement and ignores its rows.
  [[nodiscard]] Result<void> run() {
    return each([] { return true; });
  }

  /// Rejects the present row as one that was never written: the file is damaged.
  void reject() { note(SQLITE_CORRUPT); }

  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  /// Rejects a value out of bounds.
  [[nodiscard]] std::int64_t integer(int column, std::int64_t first, std::int64_t last);
  [[nodiscard]] double real(int column) const;
  /// Valid until the next step.
  [[nodiscard]] std::span<const std::uint8_t> bytes(int column) const;

  /// Rejects bytes of another size.
  template <std::size_t size> [[nodiscard]] std::array<std::uint8_t, size> array(int column) {
    std::array<std::uint8_t, size> all{};
    const auto held = bytes(column);
    if (held.size() == size) {
      std::ranges::copy(held, all.begin());
    } else {
      reject();
    }
    return all;
  }

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
