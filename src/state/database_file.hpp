#pragma once
// Database files of this tool: made as a whole, and used only if they are what they should be.

#include "blactl/base/error.hpp"

#include "state/sqlite.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace blactl::state {

/// What a database of one kind looks like.
struct DatabaseFormat {
  std::int32_t application_id; ///< tells our file from that of another program; not 0
  std::int32_t version;        ///< of the schema, from 1
  std::string schema;          ///< the one statement that makes it, as SQLite keeps it
  std::string file;            ///< its name in the state folder
  Text what, way_back;         ///< as DatabaseName
};

/// Opens a file that is there, to be written or read only. It is checked first: a file that is not
/// ours is not touched, one that is damaged or newer is left as it is.
[[nodiscard]] Result<Database> open_database(const std::string& path, const DatabaseFormat& format,
                                             bool writable, std::chrono::milliseconds patience);

/// Makes the file (0600), complete or not at all. It may be there by now: another process was
/// faster.
[[nodiscard]] Result<void> make_database(const std::string& path, const DatabaseFormat& format);

/// One in memory, that ends with the object.
[[nodiscard]] Result<Database> make_temporary_database(const DatabaseFormat& format);

} // namespace blactl::state
