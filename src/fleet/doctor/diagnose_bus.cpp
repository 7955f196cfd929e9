// The traffic on the bus.

#include "blactl/fleet/doctor/diagnosis.hpp"

#include "fleet/doctor/diagnosis_texts.hpp"

#include <cstdint>

namespace blactl::fleet {
namespace {

using bla::Level;

/// Above these loads, transfers are delayed noticeably.
constexpr std::uint64_t busy_permille = 700, full_permille = 900;

struct Complaint {
  can::FaultKind kind;
  const char* code;
  Level level;
  std::string name;
};

/// Complaints of a controller; its recovery is not one.
std::vector<Complaint> complaints() {
  using enum can::FaultKind;
  return {
      {bus_off, "bus_off", Level::failure, say<texts::fault_bus_off>()},
      {no_acknowledge, "no_acknowledge", Level::failure, say<texts::fault_no_acknowledge>()},
      {error_passive, "error_passive", Level::warning, say<texts::fault_error_passive>()},
      {error_warning, "error_warning", Level::warning, say<texts::fault_error_warning>()},
      {transmit_timeout, "transmit_timeout", Level::warning, say<texts::fault_transmit_timeout>()},
      {receive_overflow, "receive_overflow", Level::warning, say<texts::fault_receive_overflow>()},
      {protocol, "error_frames", Level::warning, say<texts::fault_protocol>()},
  };
}

Diagnosis silent_bus(const std::optional<Error>& silence) {
  if (silence) {
    return {
        .code = "silent", .level = Level::failure, .text = silence->message, .fix = silence->hint};
  }
  return {.code = "silent",
          .level = Level::failure,
          .text = say<texts::bus_silent>(),
          .fix = say<texts::bus_silent_fix>()};
}

} // namespace

Diagnoses diagnose_traffic(const Traffic& traffic, const std::optional<Error>& silence) {
  Diagnoses found;
  if (!traffic.has_others()) {
    found.push_back(silent_bus(silence));
  }
  if (traffic.runs_backwards()) {
    found.push_back({.code = "time_backwards",
                     .level = Level::warning,
                     .text = say<texts::log_runs_backwards>(),
                     .fix = say<texts::log_runs_backwards_fix>()});
  }
  if (traffic.standard_frames() > 0) {
    found.push_back({.code = "standard_frames",
                     .level = Level::warning,
                     .text = say<texts::bus_standard_frames>(traffic.standard_frames()),
                     .fix = say<texts::bus_standard_frames_fix>()});
  }
  if (const auto load = traffic.load_permille().value_or(0); load >= busy_permille) {
    found.push_back({.code = "bus_load",
                     .level = load >= full_permille ? Level::failure : Level::warning,
                     .text = say<texts::bus_loaded>(load / 10, load % 10),
                     .fix = say<texts::bus_loaded_fix>()});
  }
  for (const Complaint& complaint : complaints()) {
    const auto count = traffic.faults().find(complaint.kind);
    if (count != traffic.faults().end()) {
      found.push_back({.code = complaint.code,
                       .level = complaint.level,
                       .text = say<texts::bus_faults>(complaint.name, count->second),
                       .fix = say<texts::look_at_wiring>()});
    }
  }
  return found;
}

std::optional<Diagnosis> diagnose_end(const Error& error) {
  if (error.code != Code::bus_off && error.code != Code::no_acknowledge) {
    return std::nullopt;
  }
  return Diagnosis{.code = std::string(name(error.code)),
                   .level = Level::failure,
                   .text = error.message,
                   .fix = error.hint};
}

} // namespace blactl::fleet
