#pragma once
// The growing statistics of a trace on a terminal, redrawn in place.

#include "cli/output/reporter.hpp"
#include "cli/trace/stats.hpp"

#include <chrono>

namespace blactl::cli {

class StatsScreen {
 public:
  static constexpr Duration period = std::chrono::seconds(1);

  /// `stats`: null if lines are shown instead. Both outlive this.
  StatsScreen(TraceStats* stats, const Reporter& reporter) : stats_(stats), reporter_(reporter) {}

  /// Starts: the first update is one period from now.
  void begin(Time now) {
    due_ = stats_ != nullptr && reporter_.has_screen() ? now + period : never;
  }

  /// The time of the next update; never without a screen.
  [[nodiscard]] Time due() const { return due_; }

  /// Updates the screen, if it is due. False if the reader has left. Errors: io.
  [[nodiscard]] Result<bool> advance(Time now) {
    if (now < due_) {
      return true;
    }
    due_ = now + period;
    has_shown_ = true;
    return reporter_.show(stats_->text(reporter_.page()));
  }

  /// Advances to `now` without traffic; for frames with the caller's clock.
  void pass(Time now) {
    if (stats_ != nullptr) {
      stats_->pass(now);
    }
  }

  /// Makes room for the final output. Errors: io.
  [[nodiscard]] Result<bool> end() { return has_shown_ ? reporter_.show("") : Result<bool>(true); }

 private:
  TraceStats* stats_;
  const Reporter& reporter_;
  Time due_ = never;
  bool has_shown_ = false;
};

} // namespace blactl::cli
