#pragma once
// Database files of this tool: created atomically, and used only if they pass their checks.

#include "blactl/base/error.hpp"

#include "state/sqlite.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace blactl::state {

/// A version of a format that older programs have left.
struct OlderFormat {
  std::string schema;  ///< as DatabaseFormat::schema
  std::string upgrade; ///< statements that make the next version of it
};

/// The format of one kind of database.
struct DatabaseFormat {
  std::int32_t application_id;      ///< distinguishes our files from other programs'; not 0
  std::int32_t version;             ///< of the schema, from 1
  std::string schema;               ///< the one statement that creates it, as SQLite keeps it
  std::string file;                 ///< its name in the state folder
  Text what, way_back;              ///< as DatabaseName
  std::vector<OlderFormat> older{}; ///< versions 1 to version - 1, in order
  bool is_local = false;            ///< must not be written on a disk of another machine
};

/// Opens an existing file, for writing or read-only. Checks its form first: a file that is not ours
/// is not touched, one that is damaged or newer is left as it is. A transaction that was broken off
/// is rolled back, also for reading, and then the whole file is checked. So is an older version,
/// which is brought to the present one, also for reading.
[[nodiscard]] Result<Database> open_database(const std::string& path, const DatabaseFormat& format,
                                             bool writable, std::chrono::milliseconds patience);

/// Reads the whole file. PRAGMA quick_check would not compare a table with its index, which detects
/// a changed byte in an ID.
[[nodiscard]] Result<void> check_all(const Database& database);

/// Creates the file (0600), complete or not at all. Succeeds if another process was faster.
[[nodiscard]] Result<void> make_database(const std::string& path, const DatabaseFormat& format);

/// Copies a database, as it is in one moment, into a new file (0600), which is complete or not
/// there. Errors: of_system(): there is one already, or it cannot be written.
[[nodiscard]] Result<void> copy_database(const Database& database, const std::string& path);

/// Creates a database in memory that ends with the object.
[[nodiscard]] Result<Database> make_temporary_database(const DatabaseFormat& format);

} // namespace blactl::state
