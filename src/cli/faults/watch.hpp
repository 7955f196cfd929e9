#pragma once
// blactl faults --watch.

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <span>

namespace blactl::cli {

/// Reads the faults of these servos twice a second until the session ends, and prints those from
/// level `shown` up as they come and go, and servos that restart, fall silent or answer again: one
/// line for each event. Those from `counted` up that are present at the end count as found. A
/// recording is read once.
void watch_faults(std::span<const dronecan::NodeId> servos, bla::Level shown, bla::Level counted,
                  Context& context, Report& report);

} // namespace blactl::cli
