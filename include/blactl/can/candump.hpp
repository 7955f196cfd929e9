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
#include "blactl/can/log_line.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace blactl::can {

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
