#pragma once
// The time of a log: from the stamps of its lines to a bus clock that never goes back.

#include "blactl/base/time.hpp"
#include "blactl/can/log_line.hpp"

namespace blactl::can {

/// The bus clock begins at 0 with the first line that has a stamp. A stamp before the last one
/// (several interfaces, a wall clock that was set) does not turn it back. A line without a stamp
/// has the time of the line before.
///
/// Stamps that count from the first frame (`-t z`) and from the last one (`-t d`) look alike. They
/// count from the first until one goes back to less than half of the last, or by more than 10 ms,
/// which no log of the first kind does: from there on they are added up.
class LogClock {
 public:
  /// Advances to the time of this line.
  void pass(const LogLine& line);

  /// The time since the first stamp.
  [[nodiscard]] Time now() const { return now_; }

  /// The wall time of the last stamp; counted from 1970 where the log has no date.
  [[nodiscard]] WallTime wall() const { return wall_; }

 private:
  Time now_{};
  WallTime wall_{};
  LogLine::Stamp stamp_ = LogLine::Stamp::none; ///< of the last line that had one
  WallTime last_{};
  bool adds_up_ = false;
};

} // namespace blactl::can
