#pragma once
// What blactl doctor shows.

#include "blactl/base/json_writer.hpp"

#include "cli/doctor/examination.hpp"
#include "cli/output/page.hpp"

#include <string>

namespace blactl::cli {

/// "nodes" and "findings".
void write_json(JsonWriter& json, const Examination& examination);

/// What was looked at, a line each, then what is wrong and what mends it.
[[nodiscard]] std::string text(const Examination& examination, const Page& page);

} // namespace blactl::cli
