#pragma once
// Reads the files with settings that a command is given.

#include "blactl/fleet/files/fleet_file.hpp"

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

/// Reads a fleet file or a parameter file, and notes skipped parts; empty: the report has the
/// reason. The profiles must have been read. Errors: bad_file.
[[nodiscard]] std::optional<fleet::FleetFile> read_settings(const std::string& file,
                                                            const Context& context, Report& report);

} // namespace blactl::cli
