#include "blactl/fleet/configuration.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/fleet/texts.hpp"

#include <string>

namespace blactl::fleet {

namespace {

constexpr bla::Address fault_warning{0x1A};
constexpr std::int64_t rom_unreadable = 1 << 15; // 0x1A, requirement 65

} // namespace

std::vector<const bla::Parameter*> configuration(const bla::Profiles& profiles,
                                                 const Member& servo) {
  std::vector<const bla::Parameter*> wanted;
  for (const bla::Parameter& known : profiles.registers()) {
    const bla::Parameter* parameter = servo.identity.parameter(known.address);
    if (parameter != nullptr && parameter->saved && parameter->readable() &&
        parameter->writable() && servo.identity.has(*parameter)) {
      wanted.push_back(parameter);
    }
  }
  return wanted;
}

Result<Values> factory_defaults(const bla::Profiles& profiles, const Member& servo) {
  Values defaults;
  for (const bla::Parameter* parameter : configuration(profiles, servo)) {
    if (!parameter->default_raw) {
      const std::uint8_t id = servo.id.value();
      return std::unexpected(Error{Code::no_profile,
                                   say<texts::defaults_unknown>(id, parameter->name),
                                   say<texts::defaults_unknown_hint>(), id});
    }
    defaults[parameter->address] = *parameter->default_raw;
  }
  return defaults;
}

const bla::Parameter* rom_state(const Member& servo) {
  return servo.identity.parameter(fault_warning);
}

std::optional<Error> check_rom(const ReadJob& job) {
  const auto warnings = job.raw(fault_warning);
  if (!warnings || (*warnings & rom_unreadable) == 0) {
    return std::nullopt;
  }
  const std::uint8_t id = job.member().id.value();
  return Error{Code::mismatch, say<texts::rom_unreadable>(id), say<texts::rom_unreadable_hint>(id),
               id};
}

Values values(const ReadJob& job) {
  Values all;
  for (const Reading& reading : job.readings()) {
    if (reading.raw) {
      all[reading.parameter->address] = *reading.raw;
    }
  }
  return all;
}

std::optional<Error> compare(const ReadJob& job, const Values& expected) {
  if (job.error()) {
    return job.error();
  }
  std::string differing;
  for (const Reading& reading : job.readings()) {
    if (!reading.raw) {
      return reading.raw.error();
    }
    const bla::Parameter& parameter = *reading.parameter;
    const auto wanted = expected.find(parameter.address);
    if (wanted != expected.end() && wanted->second != *reading.raw) {
      differing += differing.empty() ? "" : ", ";
      differing += say<texts::holds_instead>(parameter.name, bla::display(parameter, *reading.raw),
                                             bla::display(parameter, wanted->second));
    }
  }
  if (differing.empty()) {
    return std::nullopt;
  }
  const std::uint8_t id = job.member().id.value();
  return Error{Code::mismatch, say<texts::values_differ>(id, differing),
               say<texts::not_taken_hint>(id), id};
}

} // namespace blactl::fleet
