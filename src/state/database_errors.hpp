#pragma once
// The errors of database files.

#include "blactl/base/error.hpp"
#include "blactl/base/text.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::state {

/// The name of a database file for people.
struct DatabaseName {
  std::string path;
  Text what;     ///< "allocation table"
  Text way_back; ///< the way on after the file was moved away
};

} // namespace blactl::state

namespace blactl::state::errors {

/// Not a file of ours. The hints of this error and the next three say how to move it away.
[[nodiscard]] Error foreign(const DatabaseName& file);
[[nodiscard]] Error link(const DatabaseName& file);
/// The log (-wal, -journal) of a lost database: a new one would take it for its own.
[[nodiscard]] Error left_over(const DatabaseName& file, const std::string& log);
[[nodiscard]] Error damaged(const DatabaseName& file, std::string_view reason);
[[nodiscard]] Error newer(const DatabaseName& file, std::int64_t version, std::int64_t known);

[[nodiscard]] Error moved_away(const DatabaseName& file);
[[nodiscard]] Error busy(const DatabaseName& file);
[[nodiscard]] Error denied(const DatabaseName& file, std::string_view reason);
/// A broken transaction cannot be rolled back, for this errno.
[[nodiscard]] Error broken_off(const DatabaseName& file, int number);
[[nodiscard]] Error io(const DatabaseName& file, std::string_view reason);
/// The error for an errno: io or denied.
[[nodiscard]] Error of_system(const DatabaseName& file, int number);

} // namespace blactl::state::errors
