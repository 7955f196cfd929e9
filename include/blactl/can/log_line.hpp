#pragma once
// What one line of a log says, whatever the log's format.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"

#include <cstdint>
#include <string_view>

namespace blactl::can {

/// The content of one line.
struct LogLine {
  enum class Kind : std::uint8_t {
    frame, ///< a data or remote frame
    error, ///< an error frame: `frame.id` is its class and `frame.data` its detail
           ///< (linux/can/error.h)
    other, ///< no frame of classic CAN: CAN FD, CAN XL, headers, comments, and what loggers remark
  };

  enum class Stamp : std::uint8_t {
    none,
    /// `at` is UTC. A date of candump (`-t A`) has no time zone: it is taken as UTC. The dates of
    /// ASC and TRC are local times: they are those of this process's time zone.
    absolute,
    /// `at` counts from 1970 on: the time since the first frame (`-t z`) or since the last (`-t
    /// d`); one line alone does not show which, LogClock finds out. Logs of ASC and TRC without a
    /// date count from their start.
    relative,
  };

  Kind kind = Kind::other;
  Stamp stamp = Stamp::none;
  Frame frame{};
  WallTime at{};                ///< truncated to microseconds
  std::string_view interface{}; ///< foreign text; points into the line, or to its reader
};

} // namespace blactl::can
