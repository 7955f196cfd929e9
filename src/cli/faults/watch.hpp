#pragma once
// blactl faults --watch.

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <span>

namespace blactl::cli {

/// Reads the faults of these servos twice a second until the session ends, and prints those from
/// `shown` up as they come and go: a line each, or on a terminal the list as it is. Those from
/// `counted` up that are there in the end are found. Of a recording: what is in it, once.
void watch_faults(std::span<const dronecan::NodeId> servos, bla::Level shown, bla::Level counted,
                  Context& context, Report& report);

} // namespace blactl::cli
