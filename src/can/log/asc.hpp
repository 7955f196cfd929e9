#pragma once
// The text of Vector's ASC logs (CANoe, CANalyzer, and others that write their format).
//
//   date Sat Sep 30 03:06:13.191 pm 2017
//   base hex  timestamps absolute
//   Begin Triggerblock Sat Sep 30 03:06:13.191 pm 2017
//      0.015991 1  1401552Ax       Rx   d 8 D2 04 00 00 00 07 00 C0  Length = 273910 BitCount = 141
//
// Vector's document is "CAN, Log & Trigger ASC Logging Format". Source of what is here: asc2log of
// can-utils, asc.py of python-can and its sample logs.

#include "blactl/base/time.hpp"
#include "blactl/can/log_line.hpp"

#include "can/log/log_words.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace blactl::can {

/// Reads an ASC log line by line. Its channel 1 is the interface "can1".
///
/// Frames are read only behind a line `base`, which says how their numbers are written and what
/// their times count from. Frames of CAN FD, requests to transmit (TxRq) and whatever else is no
/// frame are LogLine::Kind::other.
class AscLog {
 public:
  /// Whether an ASC log begins so: `date` or `base`, with what belongs to it.
  [[nodiscard]] static bool begins(std::string_view line);

  /// Empty: not a line of an ASC log. A trailing line end is allowed. The strings are valid until
  /// the next call. Never allocates.
  [[nodiscard]] std::optional<LogLine> parse(std::string_view line);

 private:
  enum class Base : std::uint8_t { unknown, hex, dec };

  [[nodiscard]] bool take_header(std::string_view first, Words& in);
  [[nodiscard]] bool take_base(Words& in);
  [[nodiscard]] bool take_time(std::string_view word, Words rest, LogLine& line);
  [[nodiscard]] std::optional<LogLine> event(std::string_view time, Words& in);
  [[nodiscard]] bool take_channel(std::string_view word, LogLine& line);
  [[nodiscard]] bool take_classic(std::string_view channel, Words& in, LogLine& line);
  [[nodiscard]] bool take_fd(Words& in, LogLine& line);
  [[nodiscard]] bool take_id(std::string_view word, Base base, Frame& frame) const;
  [[nodiscard]] bool take_data(Words& in, Frame& frame) const;
  [[nodiscard]] std::optional<std::uint32_t> byte(std::string_view word) const;

  Base base_ = Base::unknown;
  bool adds_up_ = false;          ///< times count from the line before
  Duration elapsed_{};            ///< at the last time
  std::optional<WallTime> start_; ///< of the measurement
  std::optional<WallTime> block_; ///< when the block began whose first time has not been read
  ChannelName channel_;
};

} // namespace blactl::can
