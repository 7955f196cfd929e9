#pragma once
// The text of candump (can-utils), one line a frame: read in every format that it prints, written
// as `candump -l` does.
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

/// What one line says.
struct LogLine {
  enum class Kind : std::uint8_t {
    frame, ///< a data or remote frame
    error, ///< an error frame: `frame.id` is its class and `frame.data` its detail
           ///< (linux/can/error.h)
    other, ///< no classic CAN: CAN FD, CAN XL, and what candump tells between the frames
  };

  enum class Stamp : std::uint8_t {
    none,
    /// `at` is UTC. A date (`-t A`) has no time zone: it is taken as UTC.
    absolute,
    /// `at` counts from 1970 on: the time since the first frame (`-t z`) or since the last (`-t
    /// d`), which one line alone does not tell; LogClock does.
    relative,
  };

  Kind kind = Kind::other;
  Stamp stamp = Stamp::none;
  Frame frame{};
  WallTime at{};                ///< what is finer than a microsecond (`-N`) is cut off
  std::string_view interface{}; ///< part of the line; foreign
};

/// Empty: no line of candump. A line end may be left at the end. Never allocates.
[[nodiscard]] std::optional<LogLine> parse_line(std::string_view line);

/// Room for one line of format_line().
using LineBuffer = std::array<char, 96>;

/// The longest name of an interface (IFNAMSIZ without its zero), as canplayer takes it.
inline constexpr std::size_t longest_interface_name = 15;

/// The line of `candump -l` for this frame, line end included: canplayer sends it again. What is
/// beyond the longest name is cut off; a time before 1970 is written as 0.
[[nodiscard]] std::string_view format_line(const Frame& frame, WallTime at,
                                           std::string_view interface, LineBuffer& buffer);

} // namespace blactl::can
