#pragma once
// The text of candump (can-utils), one line per frame: read in every format that it prints, written
// in that of `candump -l`.
//
//   log     (1436509052.249713) can0 1401552A#D2040000000700C0
//   screen   (1436509052.249713)  can0  1401552A   [8]  D2 04 00 00 00 07 00 C0
//
// Source: can-utils, candump.c and lib.c (sprint_canframe, sprint_long_canframe).

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace blactl::can {

/// The content of one line.
struct LogLine {
  enum class Kind : std::uint8_t {
    frame, ///< a data or remote frame
    error, ///< an error frame: `frame.id` is its class and `frame.data` its detail
           ///< (linux/can/error.h)
    other, ///< not classic CAN: CAN FD, CAN XL, and candump's remarks between frames
  };

  enum class Stamp : std::uint8_t {
    none,
    /// `at` is UTC. A date (`-t A`) has no time zone: it is taken as UTC.
    absolute,
    /// `at` counts from 1970 on: the time since the first frame (`-t z`) or since the last (`-t
    /// d`); one line alone does not show which, LogClock finds out.
    relative,
  };

  Kind kind = Kind::other;
  Stamp stamp = Stamp::none;
  Frame frame{};
  WallTime at{};                ///< truncated to microseconds (`-N` has more digits)
  std::string_view interface{}; ///< points into the line; foreign text
};

/// Empty: not a line of candump. A trailing line end is allowed. Never allocates.
[[nodiscard]] std::optional<LogLine> parse_line(std::string_view line);

/// Room for one line of format_line().
using LineBuffer = std::array<char, 96>;

/// The longest interface name (IFNAMSIZ less the zero byte) that canplayer accepts.
inline constexpr std::size_t longest_interface_name = 15;

/// The line of `candump -l` for this frame, line end included; canplayer can replay it. Names
/// longer than the limit are truncated; a time before 1970 is written as 0.
[[nodiscard]] std::string_view format_line(const Frame& frame, WallTime at,
                                           std::string_view interface, LineBuffer& buffer);

} // namespace blactl::can
