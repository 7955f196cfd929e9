#include "blactl/fleet/bus/snapshot.hpp"

#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace blactl::fleet {

namespace {

/// One error for everything missing in a recording: for a servo that was never read that is
/// everything.
std::optional<Error> not_recorded(const Snapshot& snapshot) {
  constexpr std::size_t most_names = 8;
  std::string names;
  std::size_t count = 0;
  for (const Reading& reading : snapshot.readings) {
    if (reading.raw || reading.raw.error().code != Code::not_recorded) {
      continue;
    }
    if (count++ < most_names) {
      names += names.empty() ? "" : ", ";
      names += reading.parameter->name;
    }
  }
  if (count == 0) {
    return std::nullopt;
  }
  const std::string list =
      count > most_names ? say<texts::and_more>(names, count - most_names) : names;
  const std::uint8_t id = snapshot.servo.id.value();
  return Error{Code::not_recorded, say<texts::not_recorded>(id, list),
               say<texts::not_recorded_hint>(), id};
}

} // namespace

std::optional<std::int64_t> Snapshot::raw(bla::Address address) const {
  for (const Reading& reading : readings) {
    if (reading.parameter->address == address && reading.raw) {
      return *reading.raw;
    }
  }
  return std::nullopt;
}

std::optional<std::int64_t> Snapshot::pwm_mode() const {
  return raw(bla::address::pwm_mode);
}

bla::Values Snapshot::values() const {
  bla::Values all;
  for (const Reading& reading : readings) {
    if (reading.raw) {
      all[reading.parameter->address] = *reading.raw;
    }
  }
  return all;
}

std::optional<Error> Snapshot::first_error() const {
  if (error) {
    return error;
  }
  for (const Reading& reading : readings) {
    if (!reading.raw) {
      return reading.raw.error();
    }
  }
  return std::nullopt;
}

std::vector<Error> Snapshot::errors() const {
  std::vector<Error> all;
  if (error) {
    all.push_back(*error);
  }
  for (const Reading& reading : readings) {
    if (!reading.raw && reading.raw.error().code != Code::not_recorded) {
      all.push_back(reading.raw.error());
    }
  }
  if (auto lacking = not_recorded(*this)) {
    all.push_back(std::move(*lacking));
  }
  return all;
}

std::optional<Error> check_unit(std::span<const bla::Assignment> wanted, const Snapshot& before,
                                const bla::Profiles& profiles) {
  const auto mode = before.pwm_mode();
  const auto sets_mode = [](const bla::Assignment& assignment) {
    return assignment.parameter->address == bla::address::pwm_mode;
  };
  if (!mode || std::ranges::any_of(wanted, sets_mode)) {
    return std::nullopt; // parse_assignments() has compared the two
  }
  const std::uint8_t id = before.servo.id.value();
  for (const bla::Assignment& assignment : wanted) {
    if (auto fits = bla::check_pwm_unit_of_servo(profiles, assignment, *mode); !fits) {
      return Error{fits.error().code, say<texts::about_node>(id, fits.error().message),
                   fits.error().hint, id};
    }
  }
  return std::nullopt;
}

std::optional<Error> compare(const Snapshot& after, const bla::Values& expected) {
  if (auto incomplete = after.first_error()) {
    return incomplete;
  }
  std::string differing;
  for (const Reading& reading : after.readings) {
    const bla::Parameter& parameter = *reading.parameter;
    const auto wanted = bla::find(expected, parameter.address);
    if (wanted && *wanted != *reading.raw) {
      differing += differing.empty() ? "" : ", ";
      differing += say<texts::holds_instead>(parameter.name, bla::display(parameter, *reading.raw),
                                             bla::display(parameter, *wanted));
    }
  }
  if (differing.empty()) {
    return std::nullopt;
  }
  const std::uint8_t id = after.servo.id.value();
  return Error{Code::mismatch, say<texts::about_node>(id, differing),
               say<texts::not_taken_hint>(id), id};
}

const bla::Parameter* rom_state(const bla::Identity& servo) {
  return servo.parameter(bla::address::fault_warning);
}

std::optional<Error> check_rom(const Snapshot& after) {
  const auto warnings = after.raw(bla::address::fault_warning);
  if (!warnings || (*warnings & bla::fault::rom_unreadable) == 0) {
    return std::nullopt;
  }
  const std::uint8_t id = after.servo.id.value();
  return Error{Code::mismatch, say<texts::rom_unreadable>(id), say<texts::rom_unreadable_hint>(id),
               id};
}

} // namespace blactl::fleet
