#pragma once
// What can be wrong with a database file, as errors. `path` is that of the file.

#include "blactl/base/error.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::state::errors {

/// No file of ours. The hints of this and the next three say how to get it out of the way.
[[nodiscard]] Error foreign(const std::string& path);
[[nodiscard]] Error link(const std::string& path);
/// The log (-wal, -journal) of a database that is gone: a new one would take it for its own.
[[nodiscard]] Error left_over(const std::string& path, const std::string& log);
[[nodiscard]] Error damaged(const std::string& path, std::string_view reason);
[[nodiscard]] Error newer(const std::string& path, std::int64_t version, std::int64_t known);

[[nodiscard]] Error moved_away(const std::string& path);
[[nodiscard]] Error busy(const std::string& path);
[[nodiscard]] Error denied(const std::string& path, std::string_view reason);
[[nodiscard]] Error io(const std::string& path, std::string_view reason);
/// What a number of the system (errno) means: io or denied.
[[nodiscard]] Error of_system(const std::string& path, int number);

} // namespace blactl::state::errors
