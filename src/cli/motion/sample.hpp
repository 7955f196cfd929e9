#pragma once
// The samples of a commanded servo: as data with the keys of the contract (section 5, command), for
// people, and as a drawing.

#include "blactl/base/time.hpp"
#include "blactl/fleet/motion/motion_result.hpp"

#include <string>

namespace blactl::cli {

/// One line of the stream; the key of the raw target is named after its register.
[[nodiscard]] std::string json_motion(WallTime time, const fleet::MotionPlan& plan,
                                      const fleet::MotionSample& sample);

/// Comma-separated values: the header, and one line.
[[nodiscard]] std::string csv_motion_header(const fleet::MotionPlan& plan);
[[nodiscard]] std::string csv_motion(WallTime time, const fleet::MotionPlan& plan,
                                     const fleet::MotionSample& sample);

/// Columns for people, with the time since the first command: the header, and one line.
[[nodiscard]] std::string text_motion_header(const fleet::MotionPlan& plan);
[[nodiscard]] std::string text_motion(const fleet::MotionPlan& plan,
                                      const fleet::MotionSample& sample);

/// The end in one line: where the shaft is, how it got there, and what the servo does next.
[[nodiscard]] std::string motion_summary(const fleet::MotionPlan& plan,
                                         const fleet::MotionResult& result);

/// A drawing in SVG: angle, speed and torque over time, one below the other, with the target and
/// the limits.
[[nodiscard]] std::string motion_svg(const fleet::MotionPlan& plan,
                                     const fleet::MotionResult& result);

} // namespace blactl::cli
