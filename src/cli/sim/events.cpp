#include "cli/sim/events.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/json_writer.hpp"
#include "blactl/sim/bus/simulator.hpp"

#include "cli/sim/texts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace blactl::cli {
namespace {

/// "12.345678": the microseconds of `duration`, which is not negative.
std::string seconds(Duration duration) {
  constexpr Duration::rep per_second = Duration::period::den;
  return fmt::format("{}.{:06}", duration.count() / per_second, duration.count() % per_second);
}

/// The readable registers of a servo, in ascending order.
std::vector<const bla::Parameter*> readable(const sim::Memory& registers) {
  constexpr unsigned end = 0x60;
  std::vector<const bla::Parameter*> found;
  for (unsigned i = 0; i < end; ++i) {
    const auto* parameter = registers.existing(bla::Address(static_cast<std::uint8_t>(i)));
    if (parameter != nullptr && parameter->readable()) {
      found.push_back(parameter);
    }
  }
  return found;
}

/// For people: the changes that a restart would make.
std::string memory_text(const sim::Servo& servo) {
  const sim::Memory& registers = servo.registers();
  std::string unsaved;
  for (const bla::Parameter* parameter : readable(registers)) {
    const auto ram = registers.value(parameter->address);
    const auto rom = registers.rom_value(parameter->address);
    if (parameter->saved && ram != rom) {
      unsaved += say<texts::sim_unsaved>(parameter->name, ram, rom);
    }
  }
  return say<texts::sim_memory>(servo.serial_number(), servo.node_id().value(),
                                servo.rom_writes()) +
         (unsaved.empty() ? say<texts::sim_all_saved>() : unsaved) + '\n';
}

} // namespace

SimEvents::SimEvents(const Reporter& reporter, const can::Loop& loop, sim::Clock clock)
    : reporter_(reporter), power_on_(clock == sim::Clock::simulated ? Time{} : loop.now()),
      wall_power_on_(clock == sim::Clock::simulated ? sim::virtual_epoch : loop.wall()) {}

void SimEvents::print(const sim::ServoEvent& event) {
  offer(reporter_.format() == Format::json ? json(event) : text(event));
}

void SimEvents::print(const sim::Servo& servo, Time at) {
  offer(reporter_.format() == Format::json ? json(servo, at) : memory_text(servo));
}

void SimEvents::print_end(std::size_t servos, const sim::Medium::Counters* wire, Time at) {
  const double elapsed = std::chrono::duration<double>(at - power_on_).count();
  const double load =
      wire != nullptr && elapsed > 0
          ? std::chrono::duration<double>(std::min(wire->busy, at - power_on_)).count() / elapsed
          : 0;
  if (reporter_.format() != Format::json) {
    if (wire != nullptr) {
      offer(say<texts::sim_load>(fmt::format("{:.1f}", 100 * load), wire->frames, wire->errors) +
            '\n');
    }
    return;
  }
  std::string line = fmt::format("{{\"event\":\"dumped\",\"count\":{}", servos);
  if (wire != nullptr) {
    line += fmt::format(",\"bus_load\":{:.4f},\"frames\":{},\"wire_errors\":{}", load, wire->frames,
                        wire->errors);
  }
  offer(line + "}\n");
}

void SimEvents::offer(const std::string& line) {
  const auto printed = reporter_.offer(line);
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

std::string SimEvents::json(const sim::Servo& servo, Time at) const {
  const sim::Memory& registers = servo.registers();
  std::string out;
  JsonWriter json(out);
  json.begin_object();
  json.key("time");
  json.number(seconds((wall_power_on_ + (at - power_on_)).time_since_epoch()));
  json.member("event", "state");
  json.member("unique_id", hex(servo.unique_id()));
  json.member("serial_number", servo.serial_number());
  json.member("node_id", servo.node_id().value());
  json.member("count", servo.rom_writes());
  json.key("ram");
  json.begin_object();
  for (const bla::Parameter* parameter : readable(registers)) {
    json.member(parameter->address.name(), registers.value(parameter->address));
  }
  json.end_object();
  json.key("rom");
  json.begin_object();
  for (const bla::Parameter* parameter : readable(registers)) {
    if (parameter->saved) {
      json.member(parameter->address.name(), registers.rom_value(parameter->address));
    }
  }
  json.end_object();
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
