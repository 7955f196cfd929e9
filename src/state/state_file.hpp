#pragma once
// One database file in the state folder, from its location to its transactions.

#include "blactl/base/error.hpp"
#include "blactl/state/access.hpp"

#include "state/database_file.hpp"
#include "state/sqlite.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace blactl::state {

class StateFile {
 public:
  /// `folder`: from state_folder(). `format` is static. Errors beside those of Database: state (the
  /// folder is empty).
  [[nodiscard]] static Result<StateFile> open(const std::string& folder,
                                              const DatabaseFormat& format, Access access,
                                              std::chrono::milliseconds patience);

  /// For a bus that no other process can reach: a database that ends with this object.
  [[nodiscard]] static Result<StateFile> unshared(const DatabaseFormat& format);

  /// The database; null: there was no file to read.
  [[nodiscard]] const Database* database() const { return database_ ? &*database_ : nullptr; }

  /// As Database::transact(). Errors beside those of `work`: permission (it was opened for
  /// reading).
  template <class Work>
  [[nodiscard]] std::invoke_result_t<Work, const Database&> transact(Work work) const {
    if (!database_) {
      return std::unexpected(not_writable());
    }
    return database_->transact([&] { return work(*database_); });
  }

  /// Reads the whole file, if there is one. Errors: those of Database.
  [[nodiscard]] Result<void> check() const;

  /// As copy_database(). Errors also: state: there is no file to copy.
  [[nodiscard]] Result<void> copy_to(const std::string& path) const;

  /// The path of the file, even if that does not exist yet; empty: it has none.
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  StateFile(std::string path, const DatabaseFormat& format, std::optional<Database> database)
      : path_(std::move(path)), format_(&format), database_(std::move(database)) {}

  [[nodiscard]] Error not_writable() const;

  std::string path_;
  const DatabaseFormat* format_;
  std::optional<Database> database_;
};

/// A store on this file, or the error why there is none.
template <class Store> [[nodiscard]] Result<Store> store_on(Result<StateFile> file) {
  if (!file) {
    return std::unexpected(std::move(file.error()));
  }
  return Store(std::make_unique<StateFile>(std::move(*file)));
}

} // namespace blactl::state
