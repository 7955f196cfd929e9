#pragma once
// blactl alloc --static: permanent node IDs.

#include "cli/alloc/options.hpp"
#include "cli/context.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

/// Makes the IDs of the servos behind -n static, or those given by --id and --assign, and prints a
/// line for every proven move.
[[nodiscard]] Report make_static(const AllocOptions& options, Context& context);

} // namespace blactl::cli
