#pragma once
// The time of a log: from the stamps of its lines to a bus clock that never goes back.

#include "blactl/base/time.hpp"
#include "blactl/can/candump.hpp"

#include <optional>

namespace blactl::can {

/// The bus clock begins at 0 with the first line that has a stamp. A stamp before the last one
/// (several interfaces, a wall clock that was set) does not turn it back. Lines without a stamp
/// happen at the time of the line before.
///
/// Stamps that count from the first frame (`-t z`) and from the last one (`-t d`) look alike. They
/// count from the first until one goes back to less than half of the last, or by more than 10 ms,
/// which no log of the first kind does: from there on they are added up.
class LogClock {
 public:
  /// Goes on to the time of this line.
  void pass(const LogLine& line);

  /// Since the first stamp.
  [[nodiscard]] Time now() const { return now_; }

  /// What the last stamp says; 1970 and later where the log does not tell the date.
  [[nodiscard]] WallTime wall() const { return wall_; }

 private:
  Time now_{};
  WallTime wall_{};
  LogLine::Stamp stamp_ = LogLine::Stamp::none; ///< of the last line that had one
  WallTime last_{};
  bool adds_up_ = false;
};

} // namespace blactl::can
