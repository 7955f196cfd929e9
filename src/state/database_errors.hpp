#pragma once
// What can be wrong with a database file, as errors.

#include "blactl/base/error.hpp"
#include "blactl/base/text.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::state {

/// A database file as people are told of it.
struct DatabaseName {
  std::string path;
  Text what;     ///< "allocation table"
  Text way_back; ///< what comes after the file was moved away
};

} // namespace blactl::state

namespace blactl::state::errors {

/// No file of ours. The hints of this and the next three say how to get it out of the way.
[[nodiscard]] Error foreign(const DatabaseName& file);
[[nodiscard]] Error link(const DatabaseName& file);
/// The log (-wal, -journal) of a database that is gone: a new one would take it for its own.
[[nodiscard]] Error left_over(const DatabaseName& file, const std::string& log);
[[nodiscard]] Error damaged(const DatabaseName& file, std::string_view reason);
[[nodiscard]] Error newer(const DatabaseName& file, std::int64_t version, std::int64_t known);

[[nodiscard]] Error moved_away(const DatabaseName& file);
[[nodiscard]] Error busy(const DatabaseName& file);
[[nodiscard]] Error denied(const DatabaseName& file, std::string_view reason);
[[nodiscard]] Error io(const DatabaseName& file, std::string_view reason);
/// What a number of the system (errno) means: io or denied.
[[nodiscard]] Error of_system(const DatabaseName& file, int number);

} // namespace blactl::state::errors
