#pragma once
// What happens to simulated servos, on stdout a line at a time.

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
/// simulator: what a full pipe does not take is dropped and counted.
///
/// In JSON `time` is in Unix seconds, of the virtual epoch on the virtual clock; in text it is in
/// seconds since power-on.
class SimEvents {
 public:
  /// At power-on. `reporter` must outlive this; `clock`: of the simulated bus.
  SimEvents(const Reporter& reporter, const can::Loop& loop, sim::Clock clock);

  void print(const sim::ServoEvent& event);

  /// What the servo's memories hold.
  void print(const sim::Servo& servo, Time at);

  /// As the last line of a dump: how many servos there are, and what the simulated wire carried
  /// since power-on (null: the wire is real).
  void print_end(std::size_t servos, const sim::Medium::Counters* wire, Time at);

  /// stdout that cannot be written, though somebody may still read it.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// Says how many were dropped, if any were.
  void tell_losses(Report& report) const;

 private:
  void offer(const std::string& line);
  [[nodiscard]] std::string json(const sim::ServoEvent& event) const;
  [[nodiscard]] std::string text(const sim::ServoEvent& event) const;
  [[nodiscard]] std::string json(const sim::Servo& servo, Time at) const;

  const Reporter& reporter_;
  Time power_on_;
  WallTime wall_power_on_; ///< read once: events keep their order whatever wall time does
  std::uint64_t dropped_ = 0;
  std::optional<Error> error_;
};

} // namespace blactl::cli
