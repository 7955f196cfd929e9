#include "blactl/bla/pwm_mapping.hpp"

#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/value.hpp"

#include "bla/texts.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <utility>

namespace blactl::bla {

namespace at = address;

namespace {

constexpr std::array autopilot_us{1000, 1500, 2000};

struct Endpoint {
  std::int64_t pulse_us;
  std::int64_t command;
  std::optional<std::int64_t> mode;
};

std::string text_of(const Parameter& parameter, std::int64_t raw, std::int64_t mode) {
  return parameter.name + '=' + input_text(parameter, raw, mode);
}

/// "1500us:70deg"; the value may be negative.
Result<Endpoint> parse_endpoint(const Profiles& profiles, std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) {
    return fail(Code::usage, say<texts::pwm_endpoint_form>(printable(text)),
                say<texts::pwm_endpoints_example>());
  }
  const auto pulse =
      parse_value(*profiles.find(at::pwm_neutral), NamedBy::name, text.substr(0, colon));
  if (!pulse) {
    return std::unexpected(pulse.error());
  }
  const std::string_view value = text.substr(colon + 1);
  const auto command = parse_value(*profiles.find(at::pwm_output_range), NamedBy::name, value);
  const bool is_bare = !value.empty() && value.back() >= '0' && value.back() <= '9';
  if (!command && !is_bare) {
    return std::unexpected(command.error());
  }
  if (!command || !command->pwm_mode) {
    return fail(Code::usage, say<texts::pwm_endpoint_unit>(printable(text)),
                say<texts::pwm_endpoints_example>());
  }
  return Endpoint{pulse->raw, command->raw, command->pwm_mode};
}

std::string endpoints_text(const Parameter& output, const Endpoint& low, const Endpoint& high) {
  return fmt::format("{}us:{},{}us:{}", low.pulse_us, input_text(output, low.command, low.mode),
                     high.pulse_us, input_text(output, high.command, high.mode));
}

/// The mapping through two points whose values are not opposite, as options of pwm-config; empty:
/// the registers cannot hold it exactly.
std::optional<std::string> same_line(const Parameter& output, const Endpoint& low,
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
  return fmt::format("--neutral {}us --range {}us --output {}", neutral, range,
                     input_text(output, rise * range / width, low.mode));
}

/// What the registers cannot hold. Errors: usage, with the nearest that they can.
Result<void> check_endpoints(const Parameter& output, const Endpoint& low, const Endpoint& high) {
  const auto nearest = [&](Endpoint left, Endpoint right) {
    return say<texts::pwm_nearest>(endpoints_text(output, left, right));
  };
  if (low.pulse_us == high.pulse_us || low.mode != high.mode) {
    return fail(Code::usage, say<texts::pwm_endpoints_differ>(),
                say<texts::pwm_endpoints_example>());
  }
  if (low.command >= high.command) {
    return fail(Code::usage, say<texts::pwm_endpoints_fall>(),
                say<texts::pwm_endpoints_fall_hint>());
  }
  if (low.command != -high.command) {
    Endpoint left = low;
    left.command = -high.command;
    const auto same = same_line(output, low, high);
    return fail(Code::usage, say<texts::pwm_asymmetric>(),
                same ? say<texts::pwm_same_line>(*same) : nearest(left, high));
  }
  if ((low.pulse_us + high.pulse_us) % 2 != 0) {
    Endpoint right = high;
    ++right.pulse_us;
    return fail(Code::usage, say<texts::pwm_half_neutral>(), nearest(low, right));
  }
  return {};
}

} // namespace

std::optional<std::int64_t> PwmMapping::command(std::int64_t pulse_us) const {
  if (range_us == 0 || pulse_us < shortest_us() || pulse_us > longest_us()) {
    return std::nullopt;
  }
  return output_raw * (pulse_us - neutral_us) / range_us;
}

std::optional<std::int64_t> PwmMapping::limited_command(std::int64_t pulse_us) const {
  auto given = command(pulse_us);
  if (given && limit_cw) {
    given = std::min(*given, *limit_cw);
  }
  if (given && limit_ccw) {
    given = std::max(*given, *limit_ccw);
  }
  return given;
}

std::optional<std::int64_t> PwmMapping::cut_off_below_us() const {
  const bool cuts = limit_ccw && output_raw > 0 && -output_raw < *limit_ccw;
  return cuts ? std::optional(neutral_us + *limit_ccw * range_us / output_raw) : std::nullopt;
}

std::optional<std::int64_t> PwmMapping::cut_off_above_us() const {
  const bool cuts = limit_cw && output_raw > 0 && output_raw > *limit_cw;
  return cuts ? std::optional(neutral_us + *limit_cw * range_us / output_raw) : std::nullopt;
}

std::vector<std::int64_t> PwmMapping::cut_off_us() const {
  std::vector<std::int64_t> pulses;
  for (const auto& pulse : {cut_off_below_us(), cut_off_above_us()}) {
    if (pulse) {
      pulses.push_back(*pulse);
    }
  }
  return pulses;
}

std::vector<std::int64_t> PwmMapping::missed_us() const {
  std::vector<std::int64_t> pulses;
  std::ranges::copy_if(autopilot_us, std::back_inserter(pulses),
                       [this](std::int64_t pulse) { return !command(pulse); });
  return pulses;
}

std::vector<std::int64_t> PwmMapping::points_us() const {
  std::vector<std::int64_t> pulses = cut_off_us();
  pulses.insert(pulses.end(), {std::max<std::int64_t>(shortest_us(), 0), neutral_us, longest_us()});
  for (const std::int64_t pulse : autopilot_us) {
    if (command(pulse)) {
      pulses.push_back(pulse);
    }
  }
  std::ranges::sort(pulses);
  const auto repeated = std::ranges::unique(pulses);
  pulses.erase(repeated.begin(), repeated.end());
  return pulses;
}

std::optional<PwmMapping> pwm_mapping(const Values& values) {
  const auto neutral = find(values, at::pwm_neutral);
  const auto range = find(values, at::pwm_range);
  const auto output = find(values, at::pwm_output_range);
  const auto mode = find(values, at::pwm_mode);
  if (!neutral || !range || !output || !mode) {
    return std::nullopt;
  }
  const bool is_angle = *mode == 0;
  return PwmMapping{*neutral,
                    *range,
                    *output,
                    *mode,
                    find(values, is_angle ? at::angle_limit_cw : at::speed_limit_cw),
                    find(values, is_angle ? at::angle_limit_ccw : at::speed_limit_ccw),
                    !is_angle && find(values, at::speed_torque_control) == 0};
}

const std::vector<Address>& pwm_registers() {
  static const std::vector<Address> registers{
      at::fault_notice,    at::speed_torque_control, at::timeout_time,   at::pwm_neutral,
      at::pwm_range,       at::pwm_output_range,     at::pwm_mode,       at::angle_limit_cw,
      at::angle_limit_ccw, at::speed_limit_cw,       at::speed_limit_ccw};
  return registers;
}

std::string_view name(PwmInput input) {
  switch (input) {
  case PwmInput::ok: return "ok";
  case PwmInput::none: return "none";
  case PwmInput::too_short: return "short";
  case PwmInput::too_long: break;
  }
  return "long";
}

std::optional<PwmInput> pwm_input(const Values& values) {
  const auto notices = find(values, at::fault_notice);
  if (!notices) {
    return std::nullopt;
  }
  return (*notices & fault::pwm_missing) != 0     ? PwmInput::none
         : (*notices & fault::pwm_too_short) != 0 ? PwmInput::too_short
         : (*notices & fault::pwm_too_long) != 0  ? PwmInput::too_long
                                                  : PwmInput::ok;
}

std::optional<std::int64_t> pwm_fallback_ms(const Values& values) {
  return find(values, at::timeout_time);
}

std::vector<std::string> pwm_preset(std::size_t number) {
  constexpr std::array<std::array<std::string_view, 4>, pwm_presets> presets{{
      {"pwm_neutral=1520us", "pwm_range=700us", "pwm_output_range=70.0deg", "pwm_mode=angle"},
      {"pwm_neutral=1520us", "pwm_range=700us", "pwm_output_range=140.0deg", "pwm_mode=angle"},
      {"pwm_neutral=1000us", "pwm_range=500us", "pwm_output_range=70.0deg", "pwm_mode=angle"},
      {"pwm_neutral=1520us", "pwm_range=700us", "pwm_output_range=150rpm", "pwm_mode=speed"},
  }};
  const auto& preset = presets.at(number - 1);
  return {preset.begin(), preset.end()};
}

Result<std::vector<std::string>> pwm_from_endpoints(const Profiles& profiles,
                                                    std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) {
    return fail(Code::usage, say<texts::pwm_endpoint_form>(printable(text)),
                say<texts::pwm_endpoints_example>());
  }
  auto low = parse_endpoint(profiles, text.substr(0, comma));
  if (!low) {
    return std::unexpected(low.error());
  }
  auto high = parse_endpoint(profiles, text.substr(comma + 1));
  if (!high) {
    return std::unexpected(high.error());
  }
  if (low->pulse_us > high->pulse_us) {
    std::swap(*low, *high);
  }
  const Parameter& output = *profiles.find(at::pwm_output_range);
  if (const auto possible = check_endpoints(output, *low, *high); !possible) {
    return std::unexpected(possible.error());
  }
  const std::int64_t mode = *high->mode;
  return std::vector{
      text_of(*profiles.find(at::pwm_neutral), (low->pulse_us + high->pulse_us) / 2, mode),
      text_of(*profiles.find(at::pwm_range), (high->pulse_us - low->pulse_us) / 2, mode),
      text_of(output, high->command, mode), text_of(*profiles.find(at::pwm_mode), mode, mode)};
}

} // namespace blactl::bla
