// An slcan adapter, or another device on its port.

#include "blactl/fleet/doctor/diagnosis.hpp"

#include "fleet/doctor/diagnosis_texts.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace blactl::fleet {
namespace {

using bla::Level;

/// Error bits of the adapter's status, with their counterparts in error frames.
struct Flag {
  std::uint8_t bits;
  const char* code;
  Text name;
};

constexpr std::array flags{
    Flag{can::slcan_status::error_passive, "error_passive", texts::fault_error_passive},
    Flag{can::slcan_status::error_warning, "error_warning", texts::fault_error_warning},
    Flag{can::slcan_status::bus_error, "error_frames", texts::fault_protocol},
    Flag{can::slcan_status::receive_queue_full | can::slcan_status::data_overrun,
         "receive_overflow", texts::fault_receive_overflow},
    Flag{can::slcan_status::transmit_queue_full, "transmit_timeout", texts::fault_transmit_timeout},
};

Diagnosis foreign(const char* code, std::string text) {
  return {.code = code,
          .level = Level::failure,
          .text = std::move(text),
          .fix = say<texts::port_foreign_fix>()};
}

} // namespace

Diagnoses diagnose_adapter(const can::SlcanAnswers& answers, can::ForeignSpeech speech) {
  Diagnoses found;
  for (const Flag& flag : flags) {
    if ((answers.status.value_or(0) & flag.bits) != 0) {
      found.push_back({.code = flag.code,
                       .level = Level::warning,
                       .text = say<texts::adapter_faults>(choose(flag.name.en, flag.name.ja)),
                       .fix = say<texts::look_at_wiring>()});
    }
  }
  if (speech == can::ForeignSpeech::mavlink) {
    found.push_back(foreign("mavlink", say<texts::port_mavlink>()));
  }
  if (speech == can::ForeignSpeech::text) {
    found.push_back(foreign("no_slcan", say<texts::port_text>()));
  }
  return found;
}

} // namespace blactl::fleet
