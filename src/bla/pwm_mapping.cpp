#include "blactl/bla/pwm_mapping.hpp"

#include "blactl/bla/fault_bits.hpp"

#include <algorithm>
#include <iterator>

namespace blactl::bla {

namespace at = address;

namespace {

constexpr std::array autopilot_us{1000, 1500, 2000};

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
  if (!limit_ccw || output_raw <= 0 || -output_raw >= *limit_ccw) {
    return std::nullopt;
  }
  const std::int64_t pulse = neutral_us + *limit_ccw * range_us / output_raw;
  return pulse >= 0 ? std::optional(pulse) : std::nullopt; // a pulse cannot be shorter
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

} // namespace blactl::bla
