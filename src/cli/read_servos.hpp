#pragma once
// How read-only commands find their servos.

#include "blactl/fleet/bus/snapshot.hpp"

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// Opens the interface, if something may be sent or it is a recording; false: the report has the
/// reason. Errors: usage (--listen-only; `command` is named), and those of Context::open().
[[nodiscard]] bool open_for_reading(std::string_view command, Context& context, Report& report);

/// Opens the interface and finds the servos behind -n. Errors of single servos, or of a broken
/// session, are in the report. Empty: the report has the reason why nothing can be read.
[[nodiscard]] std::optional<std::vector<dronecan::NodeId>>
select_for_reading(std::string_view command, Context& context, Report& report);

/// Notes the servos that their unique IDs do not tell from others.
void note_copies(std::span<const fleet::Snapshot> servos, Context& context);

} // namespace blactl::cli
