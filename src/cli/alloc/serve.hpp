#pragma once
// blactl alloc: the allocator of a bus, until it is stopped or no unit asks any more.

#include "cli/alloc/options.hpp"
#include "cli/context.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

/// Allocates node IDs, and prints a line for each event, or the list of units on a terminal.
[[nodiscard]] Report serve_allocations(const AllocOptions& options, Context& context);

} // namespace blactl::cli
