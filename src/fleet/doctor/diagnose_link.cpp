// The setup of the interface by the kernel, and the needed changes.

#include "blactl/can/link_setup.hpp"
#include "blactl/fleet/doctor/diagnosis.hpp"

#include "fleet/doctor/diagnosis_texts.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

namespace blactl::fleet {
namespace {

using bla::Level;

/// In thousandths: the actual values of common controller clocks for a setting of 87.5 %.
constexpr std::uint32_t least_sample_point = 850, most_sample_point = 900;

/// The queue length that kernels give an interface by default.
constexpr std::uint32_t usual_queue = 10;

bool has_wrong_bit_rate(const can::Link& link) {
  return link.bit_rate && *link.bit_rate != can::servo_bit_rate;
}

bool has_wrong_sample_point(const can::Link& link) {
  const auto point = link.sample_point;
  return point && (*point < least_sample_point || *point > most_sample_point);
}

bool stays_off(const can::Link& link) {
  return link.restart_after && link.restart_after->count() == 0;
}

bool is_off(const can::Link& link) {
  return link.state == can::LinkState::bus_off;
}

bool has_short_queue(const can::Link& link) {
  return link.queue_length < usual_queue;
}

std::string set_up_again(const can::Link& link, bool restarts = false) {
  return can::command({.name = link.name,
                       .goes_down = true,
                       .sets_timing = true,
                       .sets_restart = restarts,
                       .goes_up = true});
}

/// Errors that no setting fixes.
Diagnoses diagnose_errors(const can::Link& link) {
  const std::string name = printable(link.name);
  const auto [transmit, receive] = link.errors.value_or(can::ErrorCounters{0, 0});
  const auto found = [](std::string code, std::string text) -> Diagnoses {
    return {{std::move(code), Level::warning, {}, std::move(text), say<texts::look_at_wiring>()}};
  };
  return !link.is_up ? Diagnoses()
         : link.state == can::LinkState::error_passive
             ? found("error_passive", say<texts::link_error_passive>(name, transmit, receive))
         : link.state == can::LinkState::error_warning
             ? found("error_warning", say<texts::link_error_warning>(name, transmit, receive))
             : Diagnoses();
}

Diagnoses diagnose_timing(const can::Link& link) {
  Diagnoses found;
  const std::string name = printable(link.name);
  if (has_wrong_bit_rate(link)) {
    found.push_back({.code = "bit_rate",
                     .level = Level::failure,
                     .text = say<texts::link_bit_rate>(name, *link.bit_rate),
                     .fix = set_up_again(link)});
  }
  if (has_wrong_sample_point(link)) {
    const std::uint32_t point = *link.sample_point;
    found.push_back({.code = "sample_point",
                     .level = Level::warning,
                     .text = say<texts::link_sample_point>(name, point / 10, point % 10),
                     .fix = set_up_again(link)});
  }
  return found;
}

} // namespace

Diagnoses diagnose_setup(const can::Link& link) {
  const std::string name = printable(link.name);
  if (!link.is_up) {
    return {{.code = "interface_down",
             .level = Level::failure,
             .text = say<texts::link_down>(name),
             .fix = can::up_command(link)}};
  }
  Diagnoses found = diagnose_timing(link);
  if (is_off(link)) {
    found.push_back({.code = "bus_off",
                     .level = Level::failure,
                     .text = say<texts::link_bus_off>(name),
                     .fix = set_up_again(link)});
  }
  if (stays_off(link)) {
    found.push_back({.code = "no_restart",
                     .level = Level::notice,
                     .text = say<texts::link_no_restart>(name),
                     .fix = set_up_again(link, true)});
  }
  if (has_short_queue(link)) {
    found.push_back({.code = "short_queue",
                     .level = Level::notice,
                     .text = say<texts::link_short_queue>(name, link.queue_length),
                     .fix = can::command({.name = link.name, .sets_queue = true})});
  }
  return found;
}

Diagnoses diagnose_link(const can::Link& link) {
  Diagnoses found = diagnose_setup(link);
  std::ranges::move(diagnose_errors(link), std::back_inserter(found));
  return found;
}

can::LinkSetup mending(const can::Link& link) {
  const bool is_controller = link.kind == "can";
  can::LinkSetup setup{
      .name = link.name,
      .sets_timing = is_controller &&
                     (!link.bit_rate || has_wrong_bit_rate(link) || has_wrong_sample_point(link)),
      .sets_restart = is_controller && stays_off(link),
      .sets_queue = has_short_queue(link)};
  setup.goes_down = link.is_up && (setup.sets_timing || setup.sets_restart || is_off(link));
  setup.goes_up = setup.goes_down || !link.is_up;
  return setup;
}

} // namespace blactl::fleet
