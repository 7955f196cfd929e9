#pragma once
// The results of a scan, as JSON, CSV and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/characterize/findings.hpp"

#include "cli/output/page.hpp"

#include <string>

namespace blactl::cli {

void write_json(JsonWriter& json, const fleet::Findings& findings);
[[nodiscard]] std::string csv(const fleet::Findings& findings);
[[nodiscard]] std::string text(const fleet::Findings& findings, const Page& page);

} // namespace blactl::cli
