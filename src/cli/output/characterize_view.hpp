#pragma once
// The measurements of a servo, as tables and as JSON.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/characterize/characterization.hpp"

#include "cli/output/page.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

/// Tables of measurements, observations, and settings not measured.
[[nodiscard]] std::string characterize_text(const fleet::Characterization& measured,
                                            const Page& page);

/// "nodes": the one servo. `file`: the facts file; empty: none.
void write_characterization(JsonWriter& json, const fleet::Characterization& measured,
                            const std::optional<std::string>& file, bool is_done);

} // namespace blactl::cli
