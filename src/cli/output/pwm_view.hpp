#pragma once
// The PWM mapping of servos as JSON, text, and a drawing.

#include "blactl/base/json_writer.hpp"
#include "blactl/bla/pwm_mapping.hpp"
#include "blactl/bla/values.hpp"

#include "cli/output/page.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::cli {

/// neutral_us, range_us, output_range_raw, mode, unit, pulse_min_us, pulse_max_us, input,
/// fallback_after_ms, cut_off_us, points; null if the mapping is unknown.
void write_pwm(JsonWriter& json, const bla::Values& values);

/// The mapping in words, as a plot and as a table.
[[nodiscard]] std::string pwm_text(const bla::Values& values, const Page& page);

/// The mapping in one line: "820 us -70.0 deg, 1520 us 0.0 deg, 2220 us +70.0 deg".
[[nodiscard]] std::string pwm_summary(const bla::PwmMapping& mapping);

/// A command in the unit of the mode: "-70.0 deg", "150 rpm".
[[nodiscard]] std::string pwm_command_text(const bla::PwmMapping& mapping, std::int64_t command);

/// A drawing for browsers. `title` is untrusted text.
[[nodiscard]] std::string pwm_svg(const bla::PwmMapping& mapping, std::string_view title);

} // namespace blactl::cli
