#pragma once
// What blactl doctor shows.

#include "blactl/base/json_writer.hpp"

#include "cli/doctor/examination.hpp"
#include "cli/output/page.hpp"

#include <string>

namespace blactl::cli {

/// "nodes", "fixed", "findings", and "adapter" where there is one.
void write_json(JsonWriter& json, const Examination& examination);

/// What was looked at, a line each, then what was mended, what is wrong, and what mends that.
[[nodiscard]] std::string text(const Examination& examination, const Page& page);

} // namespace blactl::cli
