#pragma once
// A sample of one servo as data: the keys of the contract (section 5, monitor).

#include "blactl/base/time.hpp"
#include "blactl/fleet/live/monitor.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// In the order of the keys.
enum class SampleField : std::uint8_t {
  time,
  angle,
  speed,
  torque,
  temperature,
  voltage,
  mode,
  health,
  faults,
  stale,
  moved, ///< only with --identify
};

inline constexpr std::array<std::string_view, 11> sample_keys{
    "time", "angle_deg", "speed_rpm",     "torque_pct", "temperature_c", "voltage_v",
    "mode", "health",    "fault_summary", "stale",      "moved"};

using SampleFields = std::vector<SampleField>;

/// All fields; `moved` only if it is watched.
[[nodiscard]] SampleFields all_sample_fields(bool with_moved);

/// The quantities needed to fill these fields.
[[nodiscard]] std::vector<fleet::LiveField> live_fields_of(const SampleFields& fields);

/// One line of the stream.
[[nodiscard]] std::string json_sample(WallTime time, const fleet::LiveServo& servo,
                                      const SampleFields& fields);

/// Comma-separated values: the header, and one line.
[[nodiscard]] std::string csv_header(const SampleFields& fields);
[[nodiscard]] std::string csv_sample(WallTime time, const fleet::LiveServo& servo,
                                     const SampleFields& fields);

/// Columns for people, in words, beside each other in 80 characters: the header, and one line.
[[nodiscard]] std::string text_header(const SampleFields& fields);
[[nodiscard]] std::string text_sample(WallTime time, const fleet::LiveServo& servo,
                                      const SampleFields& fields);

/// The quantity behind a field; empty: none.
[[nodiscard]] std::optional<fleet::LiveField> live_field(SampleField field);

/// The number of a field in its unit: "-12.3"; empty: not known.
[[nodiscard]] std::string live_text(const fleet::LiveServo& servo, fleet::LiveField field);

} // namespace blactl::cli
