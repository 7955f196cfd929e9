// The interface, and what was heard on it.

#include "blactl/fleet/diagnosis.hpp"
#include "blactl/fleet/diagnosis_texts.hpp"

#include <cstdint>
#include <utility>

namespace blactl::fleet {
namespace {

using bla::Level;

constexpr std::uint32_t servo_bit_rate = 1000000;

/// In thousandths: what clocks of common controllers come to when 87.5 % is asked for.
constexpr std::uint32_t least_sample_point = 850, most_sample_point = 900;

/// What kernels give an interface that nobody has set up.
constexpr std::uint32_t usual_queue = 10;

/// Above it, what is due waits noticeably.
constexpr std::uint64_t busy_permille = 700, full_permille = 900;

std::string set_up_again(const can::Link& link) {
  return "sudo ip link set " + printable(link.name) + " down; " + can::up_command(link);
}

Diagnoses diagnose_state(const can::Link& link) {
  const std::string name = printable(link.name);
  const auto errors = link.errors.value_or(can::ErrorCounters{0, 0});
  switch (link.state.value_or(can::LinkState::error_active)) {
  case can::LinkState::bus_off:
    return {{.code = "bus_off",
             .level = Level::failure,
             .text = say<texts::link_bus_off>(name),
             .fix = set_up_again(link)}};
  case can::LinkState::error_passive:
    return {{.code = "error_passive",
             .level = Level::warning,
             .text = say<texts::link_error_passive>(name, errors.transmit, errors.receive),
             .fix = say<texts::look_at_wiring>()}};
  case can::LinkState::error_warning:
    return {{.code = "error_warning",
             .level = Level::warning,
             .text = say<texts::link_error_warning>(name, errors.transmit, errors.receive),
             .fix = say<texts::look_at_wiring>()}};
  case can::LinkState::error_active:
  case can::LinkState::stopped:
  case can::LinkState::sleeping: break;
  }
  return {};
}

Diagnoses diagnose_timing(const can::Link& link) {
  Diagnoses found;
  const std::string name = printable(link.name);
  if (link.bit_rate && *link.bit_rate != servo_bit_rate) {
    found.push_back({.code = "bit_rate",
                     .level = Level::failure,
                     .text = say<texts::link_bit_rate>(name, *link.bit_rate),
                     .fix = set_up_again(link)});
  }
  if (const auto point = link.sample_point;
      point && (*point < least_sample_point || *point > most_sample_point)) {
    found.push_back({.code = "sample_point",
                     .level = Level::warning,
                     .text = say<texts::link_sample_point>(name, *point / 10, *point % 10),
                     .fix = set_up_again(link)});
  }
  return found;
}

struct Complaint {
  can::FaultKind kind;
  const char* code;
  Level level;
  std::string name;
};

/// What a controller complains about; that it has recovered is none of it.
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

Diagnoses diagnose_link(const can::Link& link) {
  const std::string name = printable(link.name);
  if (!link.is_up) {
    return {{.code = "interface_down",
             .level = Level::failure,
             .text = say<texts::link_down>(name),
             .fix = can::up_command(link)}};
  }
  Diagnoses found = diagnose_timing(link);
  for (Diagnosis& state : diagnose_state(link)) {
    found.push_back(std::move(state));
  }
  if (link.restart_after && link.restart_after->count() == 0) {
    found.push_back({.code = "no_restart",
                     .level = Level::notice,
                     .text = say<texts::link_no_restart>(name),
                     .fix = set_up_again(link) + " restart-ms 100"});
  }
  if (link.queue_length < usual_queue) {
    found.push_back({.code = "short_queue",
                     .level = Level::notice,
                     .text = say<texts::link_short_queue>(name, link.queue_length),
                     .fix = "sudo ip link set " + name + " txqueuelen 100"});
  }
  return found;
}

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
