#pragma once
// blactl alloc --static: node IDs for good.

#include "cli/alloc/options.hpp"
#include "cli/context.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

/// Makes the IDs of the servos behind -n static, or those that --id and --assign wish, and prints a
/// line for every move that is proven.
[[nodiscard]] Report make_static(const AllocOptions& options, Context& context);

} // namespace blactl::cli
