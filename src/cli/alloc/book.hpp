#pragma once
// blactl alloc --list, --forget, --export, --import: the allocation table, without a bus.

#include "cli/alloc/options.hpp"
#include "cli/context.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

[[nodiscard]] Report list_allocations(Context& context);
[[nodiscard]] Report forget_units(const std::vector<std::string>& units, Context& context);
[[nodiscard]] Report export_allocations(const std::string& file, Context& context);
[[nodiscard]] Report import_allocations(const std::string& file, Context& context);

} // namespace blactl::cli
