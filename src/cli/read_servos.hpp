#pragma once
// How a command that only reads comes to its servos.

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// Opens the interface, where something may be sent or it is a recording; false: the report says
/// why not. Errors: usage (--listen-only; `command` is named), and those of Context::open().
[[nodiscard]] bool open_for_reading(std::string_view command, Context& context, Report& report);

/// Opens the interface and finds the servos behind -n. What went wrong with some of them, and why
/// the session broke, is in the report then. Empty: it holds why there is nothing to read at all.
[[nodiscard]] std::optional<std::vector<dronecan::NodeId>>
select_for_reading(std::string_view command, Context& context, Report& report);

} // namespace blactl::cli
