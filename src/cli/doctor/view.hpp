#pragma once
// Output of blactl doctor.

#include "blactl/base/json_writer.hpp"

#include "cli/doctor/examination.hpp"
#include "cli/output/page.hpp"

#include <string>

namespace blactl::cli {

/// "nodes", "fixed", "findings", and "adapter" if there is one.
void write_json(JsonWriter& json, const Examination& examination);

/// One line for each examined part, then the fixes made, the problems, and their fixes.
[[nodiscard]] std::string text(const Examination& examination, const Page& page);

} // namespace blactl::cli
