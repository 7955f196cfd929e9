#pragma once
// What `blactl alloc` does, by its options.

#include "cli/alloc/options.hpp"
#include "cli/context.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

/// Allocates node IDs until it is stopped or no unit asks any more, and prints a line for each
/// event, or the list of units on a terminal.
[[nodiscard]] Report serve_allocations(const AllocOptions& options, Context& context);

/// --static: makes the IDs of the servos behind -n static, or those given by --id and --assign, and
/// prints a line for every proven move.
[[nodiscard]] Report make_static(const AllocOptions& options, Context& context);

// --list, --forget, --export, --import: the allocation table, without a bus.
[[nodiscard]] Report list_allocations(Context& context);
[[nodiscard]] Report forget_units(const std::vector<std::string>& units, Context& context);
[[nodiscard]] Report export_allocations(const std::string& file, Context& context);
[[nodiscard]] Report import_allocations(const std::string& file, Context& context);

} // namespace blactl::cli
