#pragma once
// The statistics of a trace in place on a terminal, while they grow.

#include "cli/output/reporter.hpp"
#include "cli/trace/stats.hpp"

#include <chrono>
#include <optional>

namespace blactl::cli {

class StatsScreen {
 public:
  static constexpr Duration period = std::chrono::seconds(1);

  /// `stats`: null if lines are shown instead. Both outlive this.
  StatsScreen(TraceStats* stats, const Reporter& reporter) : stats_(stats), reporter_(reporter) {}

  /// It begins: the first look is a period from now.
  void begin(Time now);

  /// When there is something to show; never without a screen.
  [[nodiscard]] Time due() const { return due_; }

  /// Shows how things are, if it is due. False if the reader has left. Errors: io.
  [[nodiscard]] Result<bool> advance(Time now);

  /// The frames have the clock of the caller: their bus is silent until `now`.
  void pass(Time now);

  /// Leaves the place to what is printed in the end. Errors: io.
  [[nodiscard]] Result<bool> end();

 private:
  TraceStats* stats_;
  const Reporter& reporter_;
  Time due_ = never;
  bool has_shown_ = false;
};

} // namespace blactl::cli
