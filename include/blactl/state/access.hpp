#pragma once
// The mode in which a database of the state folder is opened.

#include <chrono>
#include <cstdint>

namespace blactl::state {

enum class Access : std::uint8_t {
  read, ///< makes no file: without one, nothing is known
  write ///< makes the folder (0700) and the file (0600) if missing
};

/// How long a store waits for other processes before it fails as busy.
inline constexpr std::chrono::milliseconds usual_patience{3000};

} // namespace blactl::state
