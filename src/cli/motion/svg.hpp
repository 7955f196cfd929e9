#pragma once
// A command to a shaft as a drawing of target and motion.

#include "blactl/fleet/motion/motion_result.hpp"

#include <string>

namespace blactl::cli {

/// Angle, speed and torque over time, one below the other, with the target and the limits.
[[nodiscard]] std::string motion_svg(const fleet::MotionPlan& plan,
                                     const fleet::MotionResult& result);

} // namespace blactl::cli
