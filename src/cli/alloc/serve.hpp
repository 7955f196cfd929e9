#pragma once
// blactl alloc: the allocator of a bus, until it is stopped or nobody asks any more.

#include "cli/alloc/options.hpp"
#include "cli/context.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

/// Gives node IDs, and prints what happens: a line each, or on a terminal the list as it is.
[[nodiscard]] Report serve_allocations(const AllocOptions& options, Context& context);

} // namespace blactl::cli
