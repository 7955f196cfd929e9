#pragma once
// The events of simulated servos, one line each on stdout.

#include "blactl/can/loop.hpp"
#include "blactl/sim/bus/medium.hpp"
#include "blactl/sim/scenario/scenario.hpp"
#include "blactl/sim/servo/event.hpp"
#include "blactl/sim/servo/servo.hpp"

#include "cli/output/report.hpp"
#include "cli/output/reporter.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace blactl::cli {

/// Prints events as they come. A reader that has left, or does not read, never holds up the
/// simulator: lines that do not fit into a full pipe are dropped and counted.
///
/// In JSON `time` is in Unix seconds, of the virtual epoch on the virtual clock; in text it is in
/// seconds since power-on.
class SimEvents {
 public:
  /// Created at power-on. `reporter` must outlive this; `clock`: of the simulated bus.
  SimEvents(const Reporter& reporter, const can::Loop& loop, sim::Clock clock);

  void print(const sim::ServoEvent& event);

  void print(const sim::Servo& servo, Time at);

  /// Prints the last line of a dump: the number of servos, and the counters of the simulated wire
  /// since power-on (null: the wire is real).
  void print_end(std::size_t servos, const sim::Medium::Counters* wire, Time at);

  /// The error of an unwritable stdout that may still have a reader.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// Notes the number of dropped lines, if any.
  void tell_losses(Report& report) const;

 private:
  void offer(const std::string& line);
  [[nodiscard]] std::string json(const sim::ServoEvent& event) const;
  [[nodiscard]] std::string text(const sim::ServoEvent& event) const;
  [[nodiscard]] std::string json(const sim::Servo& servo, Time at) const;

  const Reporter& reporter_;
  Time power_on_;
  WallTime wall_power_on_; ///< read once, so that events keep their order if wall time is set
  std::uint64_t dropped_ = 0;
  std::optional<Error> error_;
};

} // namespace blactl::cli
