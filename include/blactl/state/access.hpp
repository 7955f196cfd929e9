#pragma once
// How a database of the state folder is used.

#include <chrono>
#include <cstdint>

namespace blactl::state {

enum class Access : std::uint8_t {
  read, ///< makes no file: where there is none, nothing is known
  write ///< makes the folder (0700) and the file (0600) if they are not there
};

/// How long a store waits for other processes before it says busy.
inline constexpr std::chrono::milliseconds usual_patience{3000};

} // namespace blactl::state
