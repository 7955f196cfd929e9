// The PWM mapping through two points.

#include "blactl/bla/pwm_mapping.hpp"
#include "blactl/bla/value.hpp"

#include "bla/texts.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace blactl::bla {

namespace at = address;

namespace {

struct Endpoint {
  std::int64_t pulse_us;
  std::int64_t command;
  std::optional<std::int64_t> mode;
};

/// The values that a register accepts in every model with a PWM input.
struct Range {
  std::int64_t min, max;

  [[nodiscard]] bool holds(std::int64_t raw) const { return raw >= min && raw <= max; }

  [[nodiscard]] std::int64_t nearest(std::int64_t raw) const {
    return std::max(std::min(raw, max), min);
  }
};

Range range_of(const Profiles& profiles, Address address) {
  constexpr std::int64_t any = 1'000'000;
  Range range{0, any};
  for (const Profile& profile : profiles.all()) {
    const Parameter* parameter = profile.pwm ? profile.find(address) : nullptr;
    if (parameter != nullptr && parameter->min && parameter->max) {
      range = {std::max(range.min, *parameter->min), std::min(range.max, *parameter->max)};
    }
  }
  return range;
}

/// The registers as known without a servo.
struct Registers {
  const Parameter &neutral_us, &output, &mode;
  Range neutral, range, most;
};

Registers registers_of(const Profiles& profiles) {
  return {*profiles.find(at::pwm_neutral),   *profiles.find(at::pwm_output_range),
          *profiles.find(at::pwm_mode),      range_of(profiles, at::pwm_neutral),
          range_of(profiles, at::pwm_range), range_of(profiles, at::pwm_output_range)};
}

std::string assigned(const Parameter& parameter, std::int64_t raw, std::int64_t mode) {
  return parameter.name + '=' + input_text(parameter, raw, mode);
}

/// Rewrites an error about a register value as one about a part of --endpoints.
Error about_endpoint(Error error, const Parameter& parameter) {
  const std::string name = parameter.name + '=';
  const auto replace = [&](std::string& text, std::string_view with) {
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += with.size()) {
      text.replace(at, name.size(), with);
    }
  };
  replace(error.message, "--endpoints, ");
  replace(error.hint, "");
  return error;
}

/// Checks a part of --endpoints ("neutral ") or one of its values. Errors: out_of_range.
Result<void> check_part(std::string_view part, const Parameter& parameter, std::int64_t raw,
                        Range possible, std::optional<std::int64_t> mode = std::nullopt) {
  if (possible.holds(raw)) {
    return {};
  }
  const std::string least = input_text(parameter, possible.min, mode);
  const std::string most = input_text(parameter, possible.max, mode);
  const std::string told = fmt::format("--endpoints, {}{}", part, input_text(parameter, raw, mode));
  return fail(Code::out_of_range, say<texts::value_out_of_range>(told, least, most),
              say<texts::value_range_hint>(least, most));
}

/// "1500us:70deg"; the value may be negative.
Result<Endpoint> parse_endpoint(const Registers& registers, std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) {
    return fail(Code::usage, say<texts::pwm_endpoint_form>(printable(text)),
                say<texts::pwm_endpoints_example>());
  }
  const auto pulse = parse_value(registers.neutral_us, NamedBy::name, text.substr(0, colon));
  if (!pulse) {
    return std::unexpected(about_endpoint(pulse.error(), registers.neutral_us));
  }
  const std::string_view value = text.substr(colon + 1);
  const auto command = parse_value(registers.output, NamedBy::name, value);
  const bool is_bare = !value.empty() && value.back() >= '0' && value.back() <= '9';
  if (!command && !is_bare) {
    return std::unexpected(about_endpoint(command.error(), registers.output));
  }
  if (!command || !command->pwm_mode) {
    return fail(Code::usage, say<texts::pwm_endpoint_unit>(printable(text)),
                say<texts::pwm_endpoints_example>());
  }
  const Range pulses{0, registers.neutral.max + registers.range.max};
  const Range commands{-registers.most.max, registers.most.max};
  auto fits = check_part("", registers.neutral_us, pulse->raw, pulses);
  fits = fits ? check_part("", registers.output, command->raw, commands, command->pwm_mode) : fits;
  return fits ? Result<Endpoint>({pulse->raw, command->raw, command->pwm_mode})
              : std::unexpected(fits.error());
}

/// The mapping through two points whose values are not opposite, as options of pwm-config; empty:
/// the registers cannot hold it exactly.
std::optional<std::string> same_line(const Registers& registers, const Endpoint& low,
                                     const Endpoint& high) {
  const std::int64_t width = high.pulse_us - low.pulse_us, rise = high.command - low.command;
  if (low.command * width % rise != 0) {
    return std::nullopt;
  }
  const std::int64_t neutral = low.pulse_us - low.command * width / rise;
  const std::int64_t range = std::max(std::abs(low.pulse_us - neutral), high.pulse_us - neutral);
  if (range <= 0 || rise * range % width != 0) {
    return std::nullopt;
  }
  const std::int64_t output = rise * range / width;
  if (!registers.neutral.holds(neutral) || !registers.range.holds(range) ||
      !registers.most.holds(output)) {
    return std::nullopt;
  }
  return say<texts::pwm_same_line>(std::max<std::int64_t>(neutral - range, 0), neutral + range,
                                   fmt::format("--neutral {}us --range {}us --output {}", neutral,
                                               range,
                                               input_text(registers.output, output, low.mode)));
}

/// The nearest symmetric end points that the registers can hold.
std::string nearest(const Registers& registers, const Endpoint& low, const Endpoint& high) {
  const std::int64_t neutral = registers.neutral.nearest((low.pulse_us + high.pulse_us + 1) / 2);
  const std::int64_t range = registers.range.nearest((high.pulse_us - low.pulse_us + 1) / 2);
  const std::int64_t output =
      registers.most.nearest(high.command > 0 ? high.command : -low.command);
  return say<texts::pwm_nearest>(fmt::format(
      "{}us:{},{}us:{}", neutral - range, input_text(registers.output, -output, low.mode),
      neutral + range, input_text(registers.output, output, low.mode)));
}

/// Refuses end points that registers cannot hold. Errors: usage, with the nearest possible.
Result<void> check_endpoints(const Registers& registers, const Endpoint& low,
                             const Endpoint& high) {
  if (low.pulse_us == high.pulse_us || low.mode != high.mode) {
    return fail(Code::usage, say<texts::pwm_endpoints_differ>(),
                say<texts::pwm_endpoints_example>());
  }
  if (low.command >= high.command) {
    return fail(Code::usage, say<texts::pwm_endpoints_fall>(),
                say<texts::pwm_endpoints_fall_hint>());
  }
  if (low.command != -high.command) {
    return fail(Code::usage, say<texts::pwm_asymmetric>(),
                same_line(registers, low, high).value_or(nearest(registers, low, high)));
  }
  if ((low.pulse_us + high.pulse_us) % 2 != 0) {
    return fail(Code::usage, say<texts::pwm_half_neutral>(), nearest(registers, low, high));
  }
  const std::int64_t neutral = (low.pulse_us + high.pulse_us) / 2;
  const std::int64_t range = (high.pulse_us - low.pulse_us) / 2;
  auto fits = check_part("neutral ", registers.neutral_us, neutral, registers.neutral);
  fits = fits ? check_part("range ", registers.neutral_us, range, registers.range) : fits;
  if (!fits) {
    fits.error().hint = nearest(registers, low, high);
  }
  return fits;
}

} // namespace

Result<std::vector<std::string>> pwm_from_endpoints(const Profiles& profiles,
                                                    std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) {
    return fail(Code::usage, say<texts::pwm_endpoint_form>(printable(text)),
                say<texts::pwm_endpoints_example>());
  }
  const Registers registers = registers_of(profiles);
  auto low = parse_endpoint(registers, text.substr(0, comma));
  auto high = low ? parse_endpoint(registers, text.substr(comma + 1)) : low;
  if (!high) {
    return std::unexpected(high.error());
  }
  if (low->pulse_us > high->pulse_us) {
    std::swap(*low, *high);
  }
  if (const auto possible = check_endpoints(registers, *low, *high); !possible) {
    return std::unexpected(possible.error());
  }
  const std::int64_t mode = *high->mode;
  return std::vector{
      assigned(registers.neutral_us, (low->pulse_us + high->pulse_us) / 2, mode),
      assigned(*profiles.find(at::pwm_range), (high->pulse_us - low->pulse_us) / 2, mode),
      assigned(registers.output, high->command, mode), assigned(registers.mode, mode, mode)};
}

} // namespace blactl::bla
