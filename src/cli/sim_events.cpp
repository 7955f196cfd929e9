#include "sim_events.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/json_writer.hpp"
#include "blactl/sim/simulator.hpp"

#include "texts.hpp"

#include <fmt/core.h>

namespace blactl::cli {
namespace {

/// "12.345678": the microseconds of `duration`, which is not negative.
std::string seconds(Duration duration) {
  constexpr Duration::rep per_second = Duration::period::den;
  return fmt::format("{}.{:06}", duration.count() / per_second, duration.count() % per_second);
}

} // namespace

SimEvents::SimEvents(const Reporter& reporter, const can::Loop& loop, sim::Clock clock)
    : reporter_(reporter), power_on_(clock == sim::Clock::simulated ? Time{} : loop.now()),
      wall_power_on_(clock == sim::Clock::simulated ? sim::virtual_epoch : loop.wall()) {}

void SimEvents::print(const sim::ServoEvent& event) {
  const auto printed =
      reporter_.offer(reporter_.format() == Format::json ? json(event) : text(event));
  if (!printed) {
    error_ = printed.error();
  } else if (!*printed) {
    ++dropped_;
  }
}

void SimEvents::tell_losses(Report& report) const {
  if (dropped_ > 0) {
    report.counts.emplace_back("events_dropped", dropped_);
    reporter_.note(say<texts::sim_events_dropped>(dropped_));
  }
}

std::string SimEvents::json(const sim::ServoEvent& event) const {
  std::string out;
  JsonWriter json(out);
  json.begin_object();
  json.key("time");
  json.number(seconds((wall_power_on_ + (event.at - power_on_)).time_since_epoch()));
  json.member("event", sim::name(event.kind));
  json.member("unique_id", hex(event.unique_id));
  json.member("serial_number", event.serial_number);
  json.member("node_id", event.node_id.value());
  json.member("count", event.rom_writes);
  json.end_object();
  out += '\n';
  return out;
}

std::string SimEvents::text(const sim::ServoEvent& event) const {
  return say<texts::sim_event>(seconds(event.at - power_on_), sim::name(event.kind),
                               event.serial_number, event.node_id.value(), event.rom_writes) +
         '\n';
}

} // namespace blactl::cli
